/// Builds a report both as a self-contained HTML page, in the reader's light or dark mode, and as Markdown.
export module aabblab.page;

import aabb.std;
import aabblab.figures;
import aabblab.tables;

export namespace aabblab {

[[nodiscard]] std::string to_html(const table& t);

class page {
public:
    /// @param style CSS in addition to that of all pages
    explicit page(std::string_view title, std::string_view style = "");

    void title(std::string_view text);
    /// @param id the target of links to the section; the contents list only sections that have one
    void heading(std::string_view text, std::string_view id = "");
    /// Places the table of contents here: links to all sections, also to later ones, which link back.
    void contents();
    /// @param kind a CSS class, such as "soft"
    void paragraph(std::string_view text, std::string_view kind = "");
    void add(const table& t);
    void add(const named_table& t);
    /// Markdown refers to the picture in the folder `figures`, where `draw` writes it.
    void add(const figure& f);
    /// Adds a collapsed section.
    void folded(std::string_view title, const named_table& t);

    /// Adds text verbatim to only one of the two formats.
    void add_html(std::string_view text) { html_ += text; }
    void add_markdown(std::string_view text) { markdown_ += text; }
    void folded(std::string_view title, std::string_view html);

    [[nodiscard]] std::string html() const;
    [[nodiscard]] std::string markdown() const;

private:
    struct section {
        std::string text, id;
    };
    struct position {
        std::size_t html, markdown;  ///< offsets in the texts below
    };

    std::string html_, markdown_;
    std::vector<section> sections_;  // of the contents
    std::optional<position> contents_;
};

}  // namespace aabblab
