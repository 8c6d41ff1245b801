/// The standard library as a module, until libstdc++ provides `import std`. It exports only the names that the project
/// uses; missing ones are added to the lists. Macros (`assert`, `INFINITY`, `stderr`) and placement `new` need headers.
module;
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

export module aabb.std;

export namespace __gnu_cxx {
using __gnu_cxx::operator+, __gnu_cxx::operator-, __gnu_cxx::operator<=>, __gnu_cxx::operator==;
}

export namespace std {
using std::abort, std::abs, std::accumulate, std::align_val_t, std::aligned_alloc, std::allocator, std::any_of,
    std::apply, std::array, std::async, std::atoi, std::atomic, std::back_inserter, std::bad_alloc, std::basic_string,
    std::begin, std::bit_cast, std::bit_ceil, std::bit_floor, std::bit_width, std::byte, std::cbrt, std::ceil,
    std::chars_format, std::clamp, std::cmp_not_equal, std::conditional_t, std::construct_at, std::constructible_from,
    std::convertible_to, std::copy, std::copy_backward, std::copy_n, std::cos, std::count, std::countr_zero,
    std::current_exception, std::data, std::declval, std::default_delete, std::default_initializable, std::deque,
    std::derived_from, std::distance, std::dynamic_extent, std::empty, std::end, std::endian, std::erase, std::erase_if,
    std::errc, std::error_category, std::error_code, std::exception, std::exception_ptr, std::exchange,
    std::exclusive_scan, std::exit, std::exp, std::fabs, std::fclose, std::FILE, std::fflush, std::fgetc, std::fill,
    std::find, std::find_if, std::floating_point, std::floor, std::fmax, std::fmin, std::fmod, std::fopen, std::forward,
    std::fprintf, std::fputs, std::fread, std::free, std::frexp, std::from_chars, std::from_chars_result, std::function,
    std::future, std::fwrite, std::generic_category, std::get, std::get_if, std::getenv, std::getline, std::greater,
    std::has_single_bit, std::hash, std::hypot, std::ifstream, std::ilogb, std::in_place, std::in_place_t,
    std::inclusive_scan, std::index_sequence, std::initializer_list, std::inner_product, std::int16_t, std::int32_t,
    std::int64_t, std::int8_t, std::integral, std::integral_constant, std::invocable, std::invoke, std::ios,
    std::ios_base, std::iota, std::is_arithmetic_v, std::is_eq, std::is_floating_point_v, std::is_gt, std::is_gteq,
    std::is_lt, std::is_lteq, std::is_move_assignable_v, std::is_move_constructible_v, std::is_neq, std::is_pointer_v,
    std::is_trivially_copyable_v, std::is_trivially_default_constructible_v, std::is_void_v, std::isalnum, std::isdigit,
    std::isfinite, std::isinf, std::isnan, std::istream_iterator, std::istreambuf_iterator, std::istringstream,
    std::iterator_traits, std::jthread, std::launch, std::ldexp, std::length_error, std::less,
    std::lexicographical_compare, std::llround, std::log, std::log10, std::log1p, std::log2, std::logic_error,
    std::lround, std::make_error_code, std::make_index_sequence, std::make_move_iterator, std::make_tuple,
    std::make_unique, std::malloc, std::map, std::max, std::max_element, std::memcmp, std::memcpy,
    std::memory_order_relaxed, std::milli, std::min, std::minmax, std::minmax_element, std::monostate, std::move,
    std::move_iterator, std::multiplies, std::nan, std::nextafter, std::nextafterf, std::nothrow, std::nothrow_t,
    std::nth_element, std::nullopt, std::nullptr_t, std::numeric_limits, std::ofstream, std::operator!=, std::operator&,
    std::operator&=, std::operator+, std::operator-, std::operator<, std::operator<<, std::operator<=, std::operator<=>,
    std::operator==, std::operator>, std::operator>=, std::operator>>, std::operator^, std::operator|, std::operator|=,
    std::operator~, std::optional, std::ostringstream, std::pair, std::partial_ordering, std::partial_sum,
    std::partition_point, std::plus, std::popcount, std::pow, std::printf, std::ptrdiff_t, std::ref,
    std::remove_cvref_t, std::remove_if, std::remove_pointer_t, std::rethrow_exception, std::reverse, std::rewind,
    std::rotate, std::round, std::runtime_error, std::same_as, std::set, std::set_union, std::shared_ptr, std::shuffle,
    std::signbit, std::sin, std::size, std::size_t, std::snprintf, std::sort, std::span, std::sqrt, std::ssize,
    std::stable_partition, std::stable_sort, std::stod, std::stoi, std::stoul, std::strerror, std::strftime,
    std::string, std::string_view, std::strlen, std::strong_ordering, std::strtod, std::strtof, std::swap,
    std::system_error, std::thread, std::tie, std::time, std::time_t, std::timespec, std::tm, std::tmpfile,
    std::to_array, std::to_chars, std::to_integer, std::to_string, std::tolower, std::toupper, std::transform,
    std::tuple, std::tuple_cat, std::tuple_element, std::tuple_element_t, std::tuple_size, std::tuple_size_v,
    std::uint16_t, std::uint32_t, std::uint64_t, std::uint8_t, std::uintmax_t, std::uintptr_t, std::unique_ptr,
    std::unsigned_integral, std::variant, std::vector, std::visit, std::weak_ordering;
}

export namespace std::chrono {
using std::chrono::duration, std::chrono::duration_cast, std::chrono::hours, std::chrono::microseconds,
    std::chrono::milliseconds, std::chrono::minutes, std::chrono::nanoseconds, std::chrono::ceil,
    std::chrono::operator*, std::chrono::operator+, std::chrono::operator-, std::chrono::operator/,
    std::chrono::operator<, std::chrono::operator<=, std::chrono::operator<=>, std::chrono::operator==,
    std::chrono::operator>, std::chrono::operator>=, std::chrono::seconds, std::chrono::steady_clock,
    std::chrono::time_point;
}

export namespace std::filesystem {
using std::filesystem::begin, std::filesystem::canonical, std::filesystem::copy, std::filesystem::copy_options,
    std::filesystem::create_directories, std::filesystem::create_directory, std::filesystem::create_symlink,
    std::filesystem::current_path, std::filesystem::directory_entry, std::filesystem::directory_iterator,
    std::filesystem::end, std::filesystem::equivalent, std::filesystem::exists, std::filesystem::file_size,
    std::filesystem::file_time_type, std::filesystem::file_type, std::filesystem::filesystem_error,
    std::filesystem::is_directory, std::filesystem::is_empty, std::filesystem::is_fifo,
    std::filesystem::is_regular_file, std::filesystem::is_symlink, std::filesystem::last_write_time,
    std::filesystem::operator&, std::filesystem::operator|, std::filesystem::path, std::filesystem::permissions,
    std::filesystem::perms, std::filesystem::read_symlink, std::filesystem::recursive_directory_iterator,
    std::filesystem::relative, std::filesystem::remove, std::filesystem::remove_all, std::filesystem::rename,
    std::filesystem::resize_file, std::filesystem::space, std::filesystem::space_info, std::filesystem::status,
    std::filesystem::temp_directory_path, std::filesystem::weakly_canonical;
}

export namespace std::inline literals::inline chrono_literals {
using std::literals::chrono_literals::operator""ms, std::literals::chrono_literals::operator""s;
}

export namespace std::inline literals::inline string_view_literals {
using std::literals::string_view_literals::operator""sv;
}

export namespace std::numbers {
using std::numbers::pi;
}

export namespace std::ranges {
using std::ranges::adjacent_find, std::ranges::all_of, std::ranges::any_of, std::ranges::begin,
    std::ranges::binary_search, std::ranges::copy, std::ranges::copy_if, std::ranges::count, std::ranges::count_if,
    std::ranges::data, std::ranges::end, std::ranges::equal, std::ranges::equal_range, std::ranges::fill,
    std::ranges::find, std::ranges::find_if, std::ranges::find_if_not, std::ranges::for_each, std::ranges::greater,
    std::ranges::greater_equal, std::ranges::includes, std::ranges::inplace_merge, std::ranges::is_sorted,
    std::ranges::is_sorted_until, std::ranges::less, std::ranges::lower_bound, std::ranges::max,
    std::ranges::max_element, std::ranges::min, std::ranges::min_element, std::ranges::minmax,
    std::ranges::minmax_element, std::ranges::mismatch, std::ranges::move, std::ranges::none_of,
    std::ranges::not_equal_to, std::ranges::nth_element, std::ranges::partition_point, std::ranges::range,
    std::ranges::range_value_t, std::ranges::remove_copy_if, std::ranges::replace, std::ranges::reverse,
    std::ranges::rotate, std::ranges::set_difference, std::ranges::shuffle, std::ranges::size, std::ranges::sort,
    std::ranges::stable_partition, std::ranges::stable_sort, std::ranges::swap, std::ranges::transform,
    std::ranges::unique, std::ranges::upper_bound;
}

export namespace std::this_thread {
using std::this_thread::sleep_for;
}
