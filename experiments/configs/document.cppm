/// A TOML document as plain values that know their line, so that no other part of the config reader needs toml++.
module aabblab.configs:document;

import aabb.policy;
import aabb.std;

namespace aabblab {

/// The size in bytes of the largest config that is accepted.
inline constexpr std::size_t longest_config = 262'144;

enum class node_kind { text, integer, real, boolean, date, list, table };

struct node {
    node_kind kind = node_kind::table;
    int line = 0;             ///< in the file, from 1
    std::string key;          ///< set for the entries of a table
    std::string text;         ///< the value of a scalar, as settings take it
    std::vector<node> items;  ///< elements of a list, or entries of a table in file order

    /// The value of a key; null if the table lacks it.
    [[nodiscard]] const node* find(std::string_view wanted) const;
    [[nodiscard]] bool is_scalar() const { return kind < node_kind::date; }
};

struct located_text {
    std::string text;
    int line;
};

/// A parsed config that converts values to types and reports errors with their file and line.
class document {
public:
    /// @param most the maximum length in bytes
    /// @param noun the kind of document, for messages
    /// @throws aabb::input_error with line and column on malformed TOML, too long a text or too deeply nested keys.
    document(const std::string& text, std::string file, std::size_t most = longest_config,
             std::string_view noun = "a config");

    [[nodiscard]] const node& root() const { return root_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] std::filesystem::path folder() const { return std::filesystem::path(file_).parent_path(); }

    /// The place of a line in messages, "FILE:LINE".
    [[nodiscard]] std::string place(int line) const { return file_ + ":" + std::to_string(line); }
    /// Throws an input_error: "FILE:LINE: SENTENCE".
    [[noreturn]] void fail(int line, const std::string& sentence) const;
    /// Reports a value of the wrong type: "KEY is a number; expected WHAT".
    [[noreturn]] void fail_type(const std::string& key, const node& value, std::string_view expected) const;

    /// Calls the function and prefixes the message of its input_error with the place.
    decltype(auto) at_line(int line, auto function) const {
        try {
            return function();
        } catch (const aabb::input_error& error) {
            fail(line, error.what());
        }
    }

    /// Rejects unknown keys of a table.
    /// @param owner follows "key" in messages, as in " of [measure]"
    void require_keys(const node& table, const std::string& owner, const std::vector<std::string>& known) const;
    void require_table(const std::string& key, const node& value) const;
    void require_table(const std::string& key, const node& value, const std::string& owner,
                       const std::vector<std::string>& known) const {
        require_table(key, value);
        require_keys(value, owner, known);
    }
    /// The value of a required key; without it, the table is rejected with the sentence.
    [[nodiscard]] const node& required(const node& table, std::string_view key, const std::string& sentence) const;
    /// The tables of [[key]]; empty if the key is absent.
    [[nodiscard]] std::span<const node> tables_of(const std::string& key) const;
    [[nodiscard]] bool flag_of(const std::string& key, const node& value) const;
    [[nodiscard]] const std::string& text_of(const std::string& key, const node& value) const;
    [[nodiscard]] std::uint64_t integer_of(const std::string& key, const node& value, std::uint64_t least) const;
    /// Accepts a text or a list of texts.
    [[nodiscard]] std::vector<located_text> texts_of(const std::string& key, const node& value) const;
    /// The alternatives of a key, a factor of the product: a scalar, or the scalars of a list.
    [[nodiscard]] std::vector<located_text> alternatives_of(const std::string& key, const node& value) const;
    /// Removes { others_but = […] } from a list.
    /// @returns the names in it; nullopt if the list has no such entry
    [[nodiscard]] std::optional<std::vector<located_text>> take_others(node& list) const;
    /// Rejects a product that is too large before it is expanded, as a short config can describe an enormous one.
    /// @param noun the noun for the products in the message, as in "compositions"
    /// @param factors the lengths of the lists
    /// @param more the number of products that exist already
    void require_small_product(int line, std::string_view noun, std::span<const std::size_t> factors,
                               std::size_t more) const;

private:
    std::string file_;
    node root_;
};

/// The items of a list in order, without duplicates.
template <class T>
class unique_list {
public:
    /// @param text identifies the item: equal items have equal texts
    /// @returns false if the item is a duplicate
    bool add(const T& item, const std::string& text) {
        if (!texts_.insert(text).second) return false;
        items_.push_back(item);
        return true;
    }
    [[nodiscard]] const std::vector<T>& items() const { return items_; }

private:
    std::vector<T> items_;
    std::set<std::string> texts_;
};

using alternatives = std::pair<std::string, std::vector<located_text>>;

/// Reads a file up to one byte beyond `most`, so that the caller can detect that it is too long.
/// @param noun the kind of file, for messages
/// @throws aabb::input_error if the file does not exist, is a folder or cannot be read.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& file, std::size_t most, std::string_view noun);

/// The numbers of alternatives, with that of a further key, as factors of a product.
[[nodiscard]] std::vector<std::size_t> sizes_of(const std::vector<alternatives>& keys, std::size_t further);
/// The Cartesian product: one alternative per key; the first key varies slowest.
[[nodiscard]] std::vector<std::vector<aabb::setting>> cartesian_product(const std::vector<alternatives>& keys);

}  // namespace aabblab
