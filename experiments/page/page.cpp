module;

#include "page_css.hpp"

module aabblab.page;

import aabblab.markup;

namespace aabblab {

namespace {

/// A data: URI that holds the SVG, percent-encoded, so that the page has its pictures in its own file.
std::string address_of(const std::string& svg) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string address = "data:image/svg+xml,";
    for (const char c : svg) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code >= 0x7f || std::string_view("\"'#%<>&").find(c) != std::string_view::npos)
            (address += '%').append({digits[code >> 4U], digits[code & 0xfU]});
        else
            address += c;
    }
    return address;
}

constexpr std::string_view contents_id = "contents";
constexpr std::string_view contents_title = "Contents";

/// A target of links in Markdown, which has none of its own.
std::string markdown_target(std::string_view id) {
    return element("a", {{"id", id}}, "") + "\n\n";
}

/// The text as HTML, with what stands between backticks as code.
std::string with_code(std::string_view text) {
    std::string markup;
    bool is_code = false;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('`'), text.size());
        const std::string part = markup_text(text.substr(0, end));
        markup += is_code ? element("code", {}, part) : part;
        text.remove_prefix(std::min(end + 1, text.size()));
        is_code = !is_code;
    }
    return markup;
}

}  // namespace

/// The table in HTML, in an element that scrolls; columns of numbers have a class, for their alignment.
std::string to_html(const table& t) {
    const auto cell = [&](const std::string& tag, std::size_t k, const std::string& text) {
        return element(tag, {{"class", t.columns[k].is_number ? "number" : ""}}, markup_text(text));
    };
    std::string head;
    for (std::size_t k = 0; k < t.columns.size(); ++k) head += cell("th", k, t.columns[k].name);
    std::string rows = "\n" + element("tr", {}, head) + "\n";
    for (const std::vector<std::string>& cells : t.rows) {
        std::string row;
        for (std::size_t k = 0; k < cells.size(); ++k) row += cell("td", k, cells[k]);
        rows += element("tr", {}, row) + "\n";
    }
    return element("div", {{"class", "wide"}}, element("table", {}, rows)) + "\n";
}

page::page(std::string_view title, std::string_view style) {
    html_ = "<!doctype html>\n<html lang=\"en\"><head>" + element("meta", {{"charset", "utf-8"}}) + "\n" +
            element("meta", {{"name", "viewport"}, {"content", "width=device-width,initial-scale=1"}}) + "\n" +
            element("link", {{"rel", "icon"}, {"href", "data:,"}}) + "\n" + element("title", {}, markup_text(title)) +
            "\n<style>\n" + std::string(embedded::page_css) + std::string(style) + "</style></head><body>\n";
}

void page::title(std::string_view text) {
    html_ += element("h1", {}, markup_text(text)) + "\n";
    markdown_ += "# " + std::string(text) + "\n\n";
}

void page::heading(std::string_view text, std::string_view id) {
    std::string markup = markup_text(text);
    if (contents_)
        markup += " " + element("a", {{"class", "up"}, {"href", "#" + std::string(contents_id)}}, contents_title);
    html_ += element("h2", {{"id", id}}, markup) + "\n";
    if (!id.empty()) {
        sections_.push_back({std::string(text), std::string(id)});
        markdown_ += markdown_target(id);
    }
    markdown_ += "## " + std::string(text) + "\n\n";
}

void page::contents() {
    contents_ = {.html = html_.size(), .markdown = markdown_.size()};
}

/// The page, with the list of all sections inserted where `contents` was called.
std::string page::html() const {
    std::string text = html_;
    if (contents_) {
        std::string entries = "\n";
        for (const section& s : sections_)
            entries += element("li", {}, element("a", {{"href", "#" + s.id}}, markup_text(s.text))) + "\n";
        text.insert(contents_->html, element("nav", {{"id", contents_id}},
                                             element("h2", {}, contents_title) + "\n" + element("ul", {}, entries)) +
                                         "\n");
    }
    return text + "</body></html>\n";
}

std::string page::markdown() const {
    std::string text = markdown_;
    if (contents_) {
        std::string list = markdown_target(contents_id) + "## " + std::string(contents_title) + "\n\n";
        for (const section& s : sections_) list += "- [" + s.text + "](#" + s.id + ")\n";
        text.insert(contents_->markdown, list + "\n");
    }
    return text;
}

void page::paragraph(std::string_view text, std::string_view kind) {
    html_ += element("p", {{"class", kind}}, with_code(text)) + "\n";
    const std::string weight = kind == "wrong" ? "**" : "";
    markdown_ += weight + std::string(text) + weight + "\n\n";
}

void page::add(const table& t) {
    html_ += to_html(t);
    markdown_ += to_markdown(t) + "\n";
}

void page::add(const named_table& t) {
    paragraph(t.caption);
    add(t.content);
}

void page::add(const figure& f) {
    const std::string picture = element("img", {{"alt", f.caption}, {"src", address_of(svg_of(f))}});
    html_ += element("figure", {}, picture + element("figcaption", {}, markup_text(f.caption))) + "\n";
    markdown_ += "![" + f.caption + "](figures/" + f.name + ".svg)\n\n" + f.caption + "\n\n";
}

void page::folded(std::string_view title, const named_table& t) {
    folded(title, to_html(t.content));
    markdown_ += t.caption + "\n\n" + to_markdown(t.content) + "\n";
}

void page::folded(std::string_view title, std::string_view html) {
    html_ += element("details", {}, element("summary", {}, markup_text(title)) + std::string(html)) + "\n";
}

}  // namespace aabblab
