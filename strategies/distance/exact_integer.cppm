export module aabb.distance.exact_integer;

export import aabb.geometry;
import aabb.std;

export namespace aabb {

/// An exact integer by its sign and its magnitude, whose limbs are stored without leading zeros, so that small numbers
/// take little time whatever the capacity. Callers choose a capacity that holds every intermediate result.
/// @tparam Capacity in limbs of 64 bits: a sum takes one more than its longer term, a product those of both factors
template <std::size_t Capacity>
class exact_integer {
public:
    exact_integer() noexcept {}  // 0; no limb is set
    exact_integer(const exact_integer& other) noexcept : size_(other.size_), is_negative_(other.is_negative_) {
        std::copy_n(other.limb_.begin(), size_, limb_.begin());
    }
    exact_integer& operator=(const exact_integer& other) noexcept {
        size_ = other.size_;
        is_negative_ = other.is_negative_;
        std::copy_n(other.limb_.begin(), size_, limb_.begin());
        return *this;
    }
    /// ± magnitude · 2^shift.
    exact_integer(unsigned_128 magnitude, int shift, bool is_negative) noexcept : is_negative_(is_negative) {
        const auto first = static_cast<std::size_t>(shift) / 64;
        const unsigned bits = static_cast<unsigned>(shift) % 64;
        const unsigned_128 low = unsigned_128{static_cast<std::uint64_t>(magnitude)} << bits;
        const unsigned_128 high = (unsigned_128{static_cast<std::uint64_t>(magnitude >> 64U)} << bits) + (low >> 64U);
        std::fill(limb_.begin(), limb_.begin() + first, std::uint64_t{0});
        limb_[first] = static_cast<std::uint64_t>(low);
        limb_[first + 1] = static_cast<std::uint64_t>(high);
        limb_[first + 2] = static_cast<std::uint64_t>(high >> 64U);
        set_size(first + 3);
    }

    [[nodiscard]] int sign() const noexcept { return size_ == 0 ? 0 : is_negative_ ? -1 : 1; }

    [[nodiscard]] friend exact_integer operator+(const exact_integer& p, const exact_integer& q) noexcept {
        return sum(p, q, q.is_negative_);
    }
    [[nodiscard]] friend exact_integer operator-(const exact_integer& p, const exact_integer& q) noexcept {
        return sum(p, q, !q.is_negative_);
    }
    [[nodiscard]] friend exact_integer operator*(const exact_integer& p, const exact_integer& q) noexcept {
        exact_integer product;
        if (p.size_ == 0 || q.size_ == 0) return product;
        std::fill(product.limb_.begin(), product.limb_.begin() + q.size_, std::uint64_t{0});
        for (std::size_t i = 0; i < p.size_; ++i) {
            std::uint64_t carry = 0;
            for (std::size_t j = 0; j < q.size_; ++j) {
                const unsigned_128 digit = unsigned_128{p.limb_[i]} * q.limb_[j] + product.limb_[i + j] + carry;
                product.limb_[i + j] = static_cast<std::uint64_t>(digit);
                carry = static_cast<std::uint64_t>(digit >> 64U);
            }
            product.limb_[i + q.size_] = carry;
        }
        product.is_negative_ = p.is_negative_ != q.is_negative_;
        product.set_size(p.size_ + q.size_);
        return product;
    }
    [[nodiscard]] friend bool operator<=(const exact_integer& p, const exact_integer& q) noexcept {
        return (p - q).sign() <= 0;
    }

    /// Whether p · 2^shift <= q, for numbers that are not negative.
    [[nodiscard]] friend bool is_at_most(const exact_integer& p, int shift, const exact_integer& q) noexcept {
        if (p.size_ == 0 || q.size_ == 0) return p.size_ == 0;
        const int digits = p.digits() + shift;
        if (digits != q.digits()) return digits < q.digits();
        // As many digits as the other number has, so that it fits.
        return shift > 0 ? p.shifted(shift) <= q : p <= q.shifted(-shift);
    }

    /// The magnitude as mantissa · 2^exponent, the mantissa in [1/2, 1), with a relative error of at most 1.001 ·
    /// 2^-53: at least 65 of the leading 128 bits are significant, so that rounding these is in effect the only
    /// rounding. Both are 0 for 0.
    [[nodiscard]] std::pair<double, int> rounded_magnitude() const noexcept {
        if (size_ == 0) return {0, 0};
        const unsigned_128 leading =
            unsigned_128{limb_[size_ - 1]} << 64U | (size_ > 1 ? limb_[size_ - 2] : std::uint64_t{0});
        int exponent = 0;
        const double mantissa = std::frexp(static_cast<double>(leading), &exponent);
        return {mantissa, exponent + 64 * (static_cast<int>(size_) - 2)};
    }

private:
    /// The number of binary digits of a number that is not 0.
    [[nodiscard]] int digits() const noexcept {
        return static_cast<int>(64 * (size_ - 1)) + static_cast<int>(std::bit_width(limb_[size_ - 1]));
    }
    /// The number times 2^shift.
    [[nodiscard]] exact_integer shifted(int shift) const noexcept {
        const auto first = static_cast<std::size_t>(shift) / 64;
        const unsigned bits = static_cast<unsigned>(shift) % 64;
        exact_integer result;
        std::fill(result.limb_.begin(), result.limb_.begin() + first, std::uint64_t{0});
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const unsigned_128 moved = (unsigned_128{limb_[i]} << bits) | carry;
            result.limb_[first + i] = static_cast<std::uint64_t>(moved);
            carry = static_cast<std::uint64_t>(moved >> 64U);
        }
        result.size_ = first + size_;
        if (carry != 0) result.limb_[result.size_++] = carry;
        result.is_negative_ = is_negative_;
        return result;
    }

    /// Sets the size to that without leading zeros.
    void set_size(std::size_t most) noexcept {
        while (most > 0 && limb_[most - 1] == 0) --most;
        size_ = most;
    }

    /// p ± |q|.
    [[nodiscard]] static exact_integer sum(const exact_integer& p, const exact_integer& q,
                                           bool second_is_negative) noexcept {
        if (p.is_negative_ == second_is_negative) return sum_of_magnitudes(p, q, second_is_negative);
        return is_less(p, q) ? difference_of_magnitudes(q, p, second_is_negative)
                             : difference_of_magnitudes(p, q, p.is_negative_);
    }
    [[nodiscard]] static bool is_less(const exact_integer& p, const exact_integer& q) noexcept {
        if (p.size_ != q.size_) return p.size_ < q.size_;
        for (std::size_t i = p.size_; i-- > 0;)
            if (p.limb_[i] != q.limb_[i]) return p.limb_[i] < q.limb_[i];
        return false;
    }
    [[nodiscard]] static exact_integer sum_of_magnitudes(const exact_integer& p, const exact_integer& q,
                                                         bool is_negative) noexcept {
        if (p.size_ < q.size_) return sum_of_magnitudes(q, p, is_negative);
        exact_integer result;
        std::uint64_t carry = 0;
        for (std::size_t i = 0; i < p.size_; ++i) {
            const unsigned_128 digit = unsigned_128{p.limb_[i]} + (i < q.size_ ? q.limb_[i] : 0) + carry;
            result.limb_[i] = static_cast<std::uint64_t>(digit);
            carry = static_cast<std::uint64_t>(digit >> 64U);
        }
        result.size_ = p.size_;
        if (carry != 0) result.limb_[result.size_++] = carry;
        result.is_negative_ = is_negative;
        return result;
    }
    /// @param q not greater than p in magnitude
    [[nodiscard]] static exact_integer difference_of_magnitudes(const exact_integer& p, const exact_integer& q,
                                                                bool is_negative) noexcept {
        exact_integer result;
        std::uint64_t borrow = 0;
        for (std::size_t i = 0; i < p.size_; ++i) {
            const unsigned_128 difference = unsigned_128{p.limb_[i]} - (i < q.size_ ? q.limb_[i] : 0) - borrow;
            result.limb_[i] = static_cast<std::uint64_t>(difference);
            borrow = static_cast<std::uint64_t>(difference >> 64U) & 1U;
        }
        result.is_negative_ = is_negative;
        result.set_size(p.size_);
        return result;
    }

    std::array<std::uint64_t, Capacity> limb_;  // the lowest first; not set from `size_` on
    std::size_t size_ = 0;
    bool is_negative_ = false;
};

}  // namespace aabb
