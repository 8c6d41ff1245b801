module;
#include <fmt/format.h>

module aabblab.reproduction;

namespace aabblab {

namespace {

class macros {
public:
    /// Text that is TeX already.
    void set_tex(const std::string& key, const std::string& tex) { text_ += "\\aabbset{" + key + "}{" + tex + "}\n"; }
    void set(const std::string& key, std::string_view text) { set_tex(key, tex_text(text)); }
    void set(const std::string& key, std::size_t number) { set(key, std::to_string(number)); }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    std::string text_ = "% Written by ./aabblab reproduce: every number that the report names.\n";
};

/// The values of every factor over all scenes: "scene brownian, still; objects 100, 1000."
std::string setup_of(const claim_result& c) {
    std::vector<std::pair<std::string, std::vector<std::string>>> values;
    for (const factors& scene : c.scenes)
        for (const auto& [name, value] : scene) {
            auto known = std::ranges::find(values, name, &std::pair<std::string, std::vector<std::string>>::first);
            if (known == values.end()) known = values.insert(known, {name, {}});
            if (std::ranges::find(known->second, value) == known->second.end()) known->second.push_back(value);
        }
    std::string text;
    for (auto& [name, seen] : values) {
        const auto is_number = [&](const std::string& value) { return !std::isnan(number_of({{"", value}}, "")); };
        if (std::ranges::all_of(seen, is_number))
            std::ranges::sort(seen, {}, [](const std::string& value) { return number_of({{"", value}}, ""); });
        text += (text.empty() ? "" : "; ") + name + " ";
        for (const std::string& value : seen) text += (&value == seen.data() ? "" : ", ") + value;
    }
    return text.empty() ? "none were measured." : text + ".";
}

/// Names with commas, which TeX takes as they are.
template <class Named>
std::string list_of(const std::vector<Named>& all, std::size_t from = 0) {
    std::string text;
    for (std::size_t i = from; i < all.size(); ++i) text += (text.empty() ? "" : ",") + all[i].name;
    return text;
}

void add_claim(macros& to, const claim_result& c) {
    const auto set = [&](const char* key, std::string_view text) { to.set(c.id + "." + key, text); };
    set("claim", c.claim);
    set("measured", c.measured);
    set("verdict", text_of(c));
    set("sentence", c.sentence);
    set("because", c.because == c.sentence ? "" : c.because);
    to.set_tex(c.id + ".figures", list_of(c.figures));
    // The first has the endpoints, and stands in the appendix.
    to.set_tex(c.id + ".tables", list_of(c.tables, 1));
    set("setup", setup_of(c));
    set("favourable", c.expected == expectation::less ? "below 1" : "below 1.05");
    set("condition", c.has_primary ? text_of(c.primary.where) : "-");
    set("ratio", c.has_primary ? ratio_digits_of(c.primary.ratio) : "-");
    set("low", c.has_primary ? ratio_digits_of(c.primary.range.low) : "-");
    set("high", c.has_primary ? ratio_digits_of(c.primary.range.high) : "-");
    const std::vector<endpoint> others = secondaries_of(c);
    to.set(c.id + ".endpoints", others.size());
    const auto count = [&](const char* key, support what) {
        to.set(c.id + "." + key, static_cast<std::size_t>(std::ranges::count(others, what, &endpoint::found)));
    };
    count("for", support::favours);
    count("against", support::contradicts);
    count("same", support::no_difference);
    count("undecided", support::undecided);
}

}  // namespace

std::string macros_of(const reproduction& all, const provenance& made, const std::vector<std::string>& failures) {
    macros to;
    // A layout that was wrong has no row in table 1.
    for (const char* tree : {"canonical", "leafless", "shared_planes", "compressed", "compressed_literal"})
        for (const char* bytes : {"paper", "allocated"}) to.set(std::string("table1.") + tree + "." + bytes, "-");
    for (const char* name : {"table1", "table1_builds"})
        to.set(std::string("table.") + name + ".caption", "There are no measurements.");
    to.set("date", made.date);
    to.set("commit", made.commit);
    to.set("compiler", made.compiler);
    to.set("flags", made.flags);
    to.set("cpu", made.cpu);
    to.set("size", made.size);
    to.set("rows", made.rows);
    to.set("compositions", made.compositions);
    to.set("scenes", made.scenes);
    to.set("processes", made.processes);
    to.set("seeds", made.seeds);
    to.set("repeats", made.repeats);
    to.set_tex("confidence", "95\\,\\%");
    to.set_tex("band", fmt::format("{:.0f}\\,\\%", 100 * equivalence_band));
    to.set("band.low", fmt::format("{:.3f}", 1 / (1 + equivalence_band)));
    to.set("band.high", fmt::format("{:.2f}", 1 + equivalence_band));
    to.set("draws", draws_of_a_level);
    to.set("failures",
           failures.empty() ? std::string("none") : std::to_string(failures.size()) + ", " + failures.front());
    std::string ids;
    for (const claim_result& c : all.claims) ids += (ids.empty() ? "" : ",") + c.id;
    to.set_tex("claims", ids);
    to.set("claims.count", all.claims.size());
    std::string headline;
    for (const std::string& sentence : all.headline) headline += (headline.empty() ? "" : " ") + sentence;
    to.set("headline", headline);
    to.set("disturbance", all.disturbance);
    to.set("table.bands.caption", all.bands.caption);
    for (const claim_result& c : all.claims) {
        add_claim(to, c);
        for (const figure& f : c.figures) to.set("figure." + f.name + ".caption", f.caption);
        for (const named_table& t : c.tables) to.set("table." + t.name + ".caption", t.caption);
    }
    to.set("table.null_control.caption", all.null_control.caption);
    for (const figure& f : all.figures) to.set("figure." + f.name + ".caption", f.caption);
    for (const named_table& t : all.tables) {
        to.set("table." + t.name + ".caption", t.caption);
        if (t.name != "table1") continue;
        for (const std::vector<std::string>& cells : t.content.rows) {
            to.set("table1." + cells[0] + ".paper", cells[3]);
            to.set("table1." + cells[0] + ".allocated", cells[4]);
        }
    }
    return to.text();
}

}  // namespace aabblab
