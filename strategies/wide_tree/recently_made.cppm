export module aabb.wide_tree.recently_made;

import aabb.base;
import aabb.std;

export namespace aabb {

/// What was made lately, found again by its number: each number has one place, which it shares with others.
template <class Value, std::size_t MostPlaces>
class recently_made {
    static_assert(std::has_single_bit(MostPlaces));

public:
    /// Forgets all, and takes few places where there will be few numbers.
    void begin(std::size_t numbers) {
        if (values_.size() < MostPlaces && values_.size() < numbers)
            values_.resize(std::min(MostPlaces, std::bit_ceil(numbers)));
        made_.fill(nothing);
    }

    /// @param make is called as `make(value)` where it is not there any more
    template <class Make>
    [[nodiscard]] inline Value& get(std::uint32_t number, const Make& make) {
        const std::size_t place = number & (values_.size() - 1);
        if (made_[place] != number) {
            make(values_[place]);
            made_[place] = number;
        }
        return values_[place];
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(values_); }

private:
    static constexpr std::uint32_t nothing = 0xffffffff;

    std::array<std::uint32_t, MostPlaces> made_{};
    std::vector<Value> values_;
};

}  // namespace aabb
