/// Reads untrusted JSON: callers request members by type, and a wrong type is rejected with its position.
export module aabblab.json;

import aabb.std;

export namespace aabblab {

/// A value in a file. Every function throws aabb::input_error if the value, or a member, has another type than
/// requested: "a.gltf: accessors[3].count must be a whole number".
class json_value {
public:
    /// How messages locate a syntax error: by line, or by byte in formats without lines.
    enum class position { line, byte };

    /// @param file the name in messages
    /// @param message the message if it is not JSON: "is not a manifest of results"
    json_value(std::string file, std::string_view text, const std::string& message, position where = position::line);

    [[nodiscard]] std::string text() const;
    [[nodiscard]] double number() const;
    [[nodiscard]] std::size_t index() const;  ///< a whole number, not negative
    [[nodiscard]] bool flag() const;
    [[nodiscard]] bool is_null() const;
    [[nodiscard]] std::vector<json_value> list() const;
    [[nodiscard]] std::vector<std::string> texts() const;

    // Members of an object.
    [[nodiscard]] bool has(const std::string& key) const;
    [[nodiscard]] json_value needed(const std::string& key) const;
    [[nodiscard]] std::size_t needed_index(const std::string& key) const { return needed(key).index(); }

    // Optional members; empty if absent.
    [[nodiscard]] std::optional<json_value> member(const std::string& key) const;
    [[nodiscard]] std::optional<std::string> text(const std::string& key) const { return as(key, &json_value::text); }
    [[nodiscard]] std::optional<double> number(const std::string& key) const { return as(key, &json_value::number); }
    [[nodiscard]] std::optional<std::size_t> index(const std::string& key) const { return as(key, &json_value::index); }
    [[nodiscard]] std::optional<bool> flag(const std::string& key) const { return as(key, &json_value::flag); }
    [[nodiscard]] std::vector<json_value> objects(const std::string& key) const;
    [[nodiscard]] std::vector<std::string> texts(const std::string& key) const;
    [[nodiscard]] std::vector<std::size_t> indices(const std::string& key) const;
    [[nodiscard]] std::optional<std::vector<double>> numbers(const std::string& key) const;
    template <std::size_t Count>
    [[nodiscard]] std::array<double, Count> numbers(const std::string& key, std::array<double, Count> fallback) const {
        if (const auto value = member(key)) value->read_numbers(fallback.data(), Count);
        return fallback;
    }

    /// "FILE: accessors[3] SENTENCE"
    [[noreturn]] void fail(const std::string& sentence) const;

private:
    struct document;

    json_value(std::shared_ptr<const document> in, const void* content, std::string place);
    void require(bool holds, const std::string& expected) const;
    void read_numbers(double* to, std::size_t count) const;

    template <class T>
    [[nodiscard]] std::optional<T> as(const std::string& key, T (json_value::*type)() const) const {
        const auto value = member(key);
        return value ? std::optional<T>((*value.*type)()) : std::nullopt;
    }

    std::shared_ptr<const document> in_;
    const void* content_;  // points into the document
    std::string place_;
};

}  // namespace aabblab
