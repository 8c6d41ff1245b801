module aabblab.results;

import aabb.base;

namespace aabblab {

namespace {

/// Reads a text of comma-separated values record by record.
class csv_reader {
public:
    csv_reader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// Reads a record, of several lines if a quoted field has line breaks; false if the text ends within it.
    bool read(csv_record& record) {
        record.line = line_;
        do {
            std::string& field = record.fields.emplace_back();
            if (next_is("\"")) {
                if (!read_quoted(field)) return false;
            } else {
                read_plain(field);
            }
        } while (skip(","));
        if (at_ == text_.size()) return false;
        if (!is_at_line_end()) fail("expected a comma or the end of the line after a closing quote");
        at_ = text_.find('\n', at_) + 1;
        ++line_;
        return true;
    }

    [[nodiscard]] std::size_t offset() const { return at_; }

private:
    [[nodiscard]] bool next_is(std::string_view text) const { return text_.substr(at_).starts_with(text); }
    /// True at a line feed, with or without carriage returns before it.
    [[nodiscard]] bool is_at_line_end() const {
        const std::size_t end = text_.find_first_not_of('\r', at_);
        return end != std::string_view::npos && text_[end] == '\n';
    }
    /// Advances over `text` if it comes next, and returns whether it did.
    bool skip(std::string_view text) {
        const bool is_next = next_is(text);
        if (is_next) at_ += text.size();
        return is_next;
    }

    /// Reads a field without quotes, which ends before a comma or at the end of the line.
    void read_plain(std::string& field) {
        while (at_ < text_.size() && !next_is(",") && !is_at_line_end()) {
            if (next_is("\"")) fail("a quote is in a field that does not begin with one");
            if (next_is("\r"))
                fail("some lines end in carriage returns alone, others in line feeds; expected one of the two");
            field += text_[at_++];
        }
    }

    /// Reads a quoted field; false if the text ends before the closing quote.
    bool read_quoted(std::string& field) {
        for (++at_; at_ < text_.size(); ++at_) {
            if (skip("\"") && !next_is("\"")) return true;  // a doubled quote stands for one
            if (text_[at_] == '\n') ++line_;
            field += text_[at_];
        }
        return false;
    }

    [[noreturn]] void fail(const char* sentence) const {
        throw aabb::input_error(file_ + ":" + std::to_string(line_) + ": " + sentence);
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;    // the position of the next character
    std::size_t line_ = 1;  // its line
};

}  // namespace

/// A record in the syntax of RFC 4180, in which a quote within quotes is doubled.
std::string csv_line(std::span<const std::string> fields) {
    std::string line;
    for (const std::string& field : fields) {
        if (&field != fields.data()) line += ',';
        const bool needs_quotes = field.find_first_of(",\"\r\n") != std::string::npos;
        if (needs_quotes) line += '"';
        for (const char c : field) line.append(c == '"' ? 2U : 1U, c);
        if (needs_quotes) line += '"';
    }
    return line + '\n';
}

/// Parses records, without a last one that was only partly written; `bytes` is the length of the text before that.
csv_text read_csv(std::string_view text, const std::string& file) {
    csv_text table;
    csv_reader reader(text, file);
    for (csv_record record; reader.read(record); record = {}) {
        table.records.push_back(std::move(record));
        table.bytes = reader.offset();
    }
    return table;
}

std::vector<csv_record> whole_records_of(std::string_view text, const std::string& file) {
    csv_text table = read_csv(text, file);
    if (table.bytes < text.size())
        throw aabb::input_error(file + ": its last row is cut off: expected a line feed after it");
    return std::move(table.records);
}

}  // namespace aabblab
