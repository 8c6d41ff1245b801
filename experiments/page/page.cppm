/// Reports, as one page of HTML that needs no other file, light or dark as its reader has it, and as Markdown.
export module aabblab.page;

import aabb.std;
import aabblab.figures;
import aabblab.tables;

export namespace aabblab {

[[nodiscard]] std::string to_html(const table& t);

class page {
public:
    /// @param style CSS, beside what all pages have
    explicit page(std::string_view title, std::string_view style = "");

    void title(std::string_view text);
    /// @param id by which links call the section
    void heading(std::string_view text, std::string_view id = "");
    /// @param kind a class of the style: "soft"
    void paragraph(std::string_view text, std::string_view kind = "");
    void add(const table& t);
    void add(const named_table& t);
    /// Markdown takes its picture from the folder `figures`, where `draw` leaves it.
    void add(const figure& f);
    /// What the reader of a page unfolds.
    void folded(std::string_view title, const named_table& t);

    /// In one of the two alone, as it is.
    void add_html(std::string_view text) { html_ += text; }
    void add_markdown(std::string_view text) { markdown_ += text; }
    void folded(std::string_view title, std::string_view html);

    [[nodiscard]] std::string html() const { return html_ + "</body></html>\n"; }
    [[nodiscard]] const std::string& markdown() const { return markdown_; }

private:
    std::string html_;
    std::string markdown_;
};

}  // namespace aabblab
