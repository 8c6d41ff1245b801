export module aabb.collision_filter:filter;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// One of two sets whose objects are tested against those of the other set only.
enum class object_set : std::uint8_t { none = 0, a = 1, b = 2 };

/// What collision filtering knows of an object; an object of which nothing was said has these defaults, and is tested
/// against every other such object. Groups and masks are those of Bullet ("Collision Filtering" in its wiki:
/// `m_collisionFilterGroup`, `m_collisionFilterMask`) and of Box2D (`b2Filter` in its manual: `categoryBits`,
/// `maskBits`), with Box2D's defaults.
struct object_filter {
    std::uint32_t group = 1;            ///< the groups of the object, one per bit
    std::uint32_t mask = 0xffff'ffff;   ///< the groups against which it is tested
    object_set set = object_set::none;  ///< if any object has a set, only pairs of one of A and one of B are kept
    bool rests = false;                 ///< two objects at rest are not tested against each other

    friend bool operator==(const object_filter&, const object_filter&) = default;
};

/// Decides which pairs of objects are kept. It must be changed between frames only, and counts from the next search on.
class collision_filter {
public:
    /// Replaces what is known of an object.
    void set(std::uint32_t id, const object_filter& object) {
        if (id >= objects_.size()) objects_.resize(std::size_t{id} + 1);
        count(objects_[id], -1);
        count(object, 1);
        objects_[id] = object;
    }
    [[nodiscard]] object_filter operator[](std::uint32_t id) const noexcept {
        return id < objects_.size() ? objects_[id] : object_filter{};
    }

    /// Adds exceptions, pairs that are not tested whatever else is known of them, each in either order, or removes such
    /// exceptions again. A call takes time for all exceptions: pass them together.
    void add_exceptions(std::span<const index_pair> pairs) {
        std::vector<index_pair> united = in_order(pairs);
        const auto added = static_cast<std::ptrdiff_t>(united.size());
        united.insert(united.end(), exceptions_.begin(), exceptions_.end());
        std::ranges::inplace_merge(united, united.begin() + added);
        united.erase(std::ranges::unique(united).begin(), united.end());
        replace_exceptions(std::move(united));
    }
    void remove_exceptions(std::span<const index_pair> pairs) {
        std::vector<index_pair> others;
        std::ranges::set_difference(exceptions_, in_order(pairs), std::back_inserter(others));
        replace_exceptions(std::move(others));
    }
    void add_exception(index_pair pair) { add_exceptions({&pair, 1}); }
    void remove_exception(index_pair pair) { remove_exceptions({&pair, 1}); }

    /// The exceptions, a < b, sorted.
    [[nodiscard]] std::span<const index_pair> exceptions() const noexcept { return exceptions_; }

    /// Whether a pair of objects is tested, in either order.
    [[nodiscard]] inline bool keeps(std::uint32_t a, std::uint32_t b) const noexcept {
        return keeps_by_attributes(a, b) && !is_exception(ordered_pair(a, b));
    }

    /// Removes the pairs from index `first` on that are not kept, in place and in order.
    /// @param object_of the object of an id in the pairs
    template <class ObjectOf>
    void apply(std::vector<index_pair>& pairs, std::size_t first, ObjectOf object_of) const {
        const auto keep_if = [&](auto is_kept) {
            std::size_t end = first;
            for (std::size_t i = first; i < pairs.size(); ++i) {  // without a branch that depends on the pair
                const index_pair pair = pairs[i];
                pairs[end] = pair;
                end += static_cast<std::size_t>(is_kept(object_of(pair.a), object_of(pair.b)));
            }
            pairs.resize(end);
        };
        if (exceptions_.empty())
            keep_if([this](std::uint32_t a, std::uint32_t b) { return keeps_by_attributes(a, b); });
        else
            keep_if([this](std::uint32_t a, std::uint32_t b) { return keeps(a, b); });
    }
    void apply(std::vector<index_pair>& pairs, std::size_t first = 0) const {
        apply(pairs, first, [](std::uint32_t id) { return id; });
    }

    /// The number of objects at rest.
    [[nodiscard]] std::size_t resting() const noexcept { return static_cast<std::size_t>(resting_); }
    [[nodiscard]] bool has_sets() const noexcept { return in_a_ + in_b_ > 0; }
    /// The numbers of objects of the smaller and of the larger set.
    [[nodiscard]] std::array<std::size_t, 2> sizes_of_sets() const noexcept {
        return {static_cast<std::size_t>(std::min(in_a_, in_b_)), static_cast<std::size_t>(std::max(in_a_, in_b_))};
    }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(objects_, exceptions_, first_exceptions_); }

private:
    void count(const object_filter& object, std::ptrdiff_t change) noexcept {
        if (object.set == object_set::a) in_a_ += change;
        if (object.set == object_set::b) in_b_ += change;
        if (object.rests) resting_ += change;
    }
    /// Whether all but the exceptions keep a pair; without branches, since pairs come in no order.
    [[nodiscard]] inline bool keeps_by_attributes(std::uint32_t a, std::uint32_t b) const noexcept {
        const object_filter first = (*this)[a];
        const object_filter second = (*this)[b];
        const unsigned both_sets = static_cast<unsigned>(object_set::a) | static_cast<unsigned>(object_set::b);
        const unsigned sets = static_cast<unsigned>(first.set) | static_cast<unsigned>(second.set);
        unsigned kept = static_cast<unsigned>((first.group & second.mask) != 0);
        kept &= static_cast<unsigned>((second.group & first.mask) != 0);
        kept &= static_cast<unsigned>(!has_sets()) | static_cast<unsigned>(sets == both_sets);
        kept &= ~(static_cast<unsigned>(first.rests) & static_cast<unsigned>(second.rests));
        return kept != 0;
    }

    /// Objects have few exceptions each, so that those of one take fewer steps to search than all of them.
    [[nodiscard]] inline bool is_exception(index_pair pair) const noexcept {
        if (std::size_t{pair.a} + 1 >= first_exceptions_.size()) return false;
        const auto of_object =
            std::span(exceptions_).first(first_exceptions_[std::size_t{pair.a} + 1]).subspan(first_exceptions_[pair.a]);
        return !of_object.empty() && std::ranges::binary_search(of_object, pair.b, {}, &index_pair::b);
    }

    /// The pairs with a < b, sorted, each once.
    [[nodiscard]] static std::vector<index_pair> in_order(std::span<const index_pair> pairs) {
        std::vector<index_pair> ordered;
        for (const auto [a, b] : pairs) ordered.push_back(ordered_pair(a, b));
        std::ranges::sort(ordered);
        ordered.erase(std::ranges::unique(ordered).begin(), ordered.end());
        return ordered;
    }
    void replace_exceptions(std::vector<index_pair> sorted) {
        std::vector<std::size_t> firsts;
        if (!sorted.empty()) firsts.reserve(std::size_t{sorted.back().a} + 2);
        for (std::size_t i = 0; i < sorted.size(); ++i) firsts.resize(std::size_t{sorted[i].a} + 1, i);
        if (!sorted.empty()) firsts.push_back(sorted.size());
        exceptions_ = std::move(sorted);
        first_exceptions_ = std::move(firsts);
    }

    std::vector<object_filter> objects_;         // by id; those beyond the end have the defaults
    std::vector<index_pair> exceptions_;         // a < b, sorted
    std::vector<std::size_t> first_exceptions_;  // by a: the index of its first exception, or of the next object's
    std::ptrdiff_t in_a_ = 0, in_b_ = 0;         // numbers of objects by set
    std::ptrdiff_t resting_ = 0;                 // number of objects at rest
};

}  // namespace aabb
