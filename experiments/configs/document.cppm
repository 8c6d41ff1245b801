/// A TOML document as plain values that know their line, so that the rest of the config reader is free of TOML.
module aabblab.configs:document;

import aabb.policy;
import aabb.std;

namespace aabblab {

/// In bytes.
inline constexpr std::size_t longest_config = 262'144;

enum class node_kind { text, integer, real, boolean, date, list, table };

struct node {
    node_kind kind = node_kind::table;
    int line = 0;             ///< from 1
    std::string key;          ///< of an entry of a table
    std::string text;         ///< a scalar, as a setting takes it
    std::vector<node> items;  ///< of a list, or the entries of a table in the order of the file

    /// The value of a key; null where there is none.
    [[nodiscard]] const node* find(std::string_view wanted) const;
    [[nodiscard]] bool is_scalar() const { return kind < node_kind::date; }
};

struct located_text {
    std::string text;
    int line;
};

/// A config on its way from text to an experiment: makes its messages.
class document {
public:
    /// @param most bytes that it may have
    /// @param what it is, for messages
    /// @throws aabb::input_error with line and column on malformed TOML, or text longer or keys deeper than any config.
    document(const std::string& text, std::string file, std::size_t most = longest_config,
             std::string_view what = "a config");

    [[nodiscard]] const node& root() const { return root_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] std::filesystem::path folder() const { return std::filesystem::path(file_).parent_path(); }

    /// "FILE:LINE"
    [[nodiscard]] std::string place(int line) const { return file_ + ":" + std::to_string(line); }
    [[noreturn]] void fail(int line, const std::string& sentence) const;
    /// "KEY is a number; expected WHAT".
    [[noreturn]] void fail_type(const std::string& key, const node& value, std::string_view expected) const;

    /// Calls a function whose input_error lacks the place.
    decltype(auto) at(int line, auto function) const {
        try {
            return function();
        } catch (const aabb::input_error& error) {
            fail(line, error.what());
        }
    }

    /// Refuses keys of a table that are not known. `of` is what the keys belong to, as in " of [measure]".
    void require_keys(const node& table, const std::string& of, const std::vector<std::string>& known) const;
    void require_table(const std::string& key, const node& value) const;
    /// Refuses a table without this key by the sentence.
    [[nodiscard]] const node& needed(const node& table, std::string_view key, const std::string& sentence) const;
    /// Those of [[key]]; none where there is no such key.
    [[nodiscard]] std::span<const node> tables_of(const std::string& key) const;
    [[nodiscard]] bool flag_of(const std::string& key, const node& value) const;
    [[nodiscard]] const std::string& text_of(const std::string& key, const node& value) const;
    [[nodiscard]] std::uint64_t integer_of(const std::string& key, const node& value, std::uint64_t least) const;
    /// A text or a list of texts.
    [[nodiscard]] std::vector<located_text> texts_of(const std::string& key, const node& value) const;
    /// What a key multiplies by: a scalar, or the scalars of a list.
    [[nodiscard]] std::vector<located_text> alternatives_of(const std::string& key, const node& value) const;
    /// Takes { others_but = […] } out of a list.
    /// @returns the names in it; nothing where the list has none
    [[nodiscard]] std::optional<std::vector<located_text>> take_others(node& list) const;
    /// Refuses lists that multiply to too much, before anything is made of them: a short text can ask for anything.
    /// @param of what they multiply to, as in "compositions"
    /// @param factors how long the lists are
    /// @param more that are there already
    void require_few(int line, std::string_view of, std::span<const std::size_t> factors, std::size_t more) const;

private:
    std::string file_;
    node root_;
};

/// What a config lists, in its order, each once.
template <class T>
class each_once {
public:
    /// @param text equal for equal ones
    /// @returns false where it is there already
    bool add(const T& one, const std::string& text) {
        if (!texts_.insert(text).second) return false;
        all_.push_back(one);
        return true;
    }
    [[nodiscard]] const std::vector<T>& all() const { return all_; }

private:
    std::vector<T> all_;
    std::set<std::string> texts_;
};

/// A key with what it multiplies by.
using alternatives = std::pair<std::string, std::vector<located_text>>;

/// What stands in a file, at most one byte more than it may have, which shows that it is too long.
/// @param what it is, for messages
/// @throws aabb::input_error where it is not there, is a folder or cannot be read.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file, std::size_t most, std::string_view what);

[[nodiscard]] std::vector<std::size_t> sizes_of(const std::vector<alternatives>& keys);
/// Every choice of one alternative a key; the first key varies slowest.
[[nodiscard]] std::vector<std::vector<aabb::setting>> multiplied(const std::vector<alternatives>& keys);

}  // namespace aabblab
