module;

#include "rule_md.hpp"

module aabblab.reproduction;

namespace aabblab {

std::vector<verdict_word> verdict_words() {
    return {{verdict_kind::holds, "Holds", "every primary ratio favours the claim"},
            {verdict_kind::in_part, "Holds in part",
             "some primary ratios favour it and some do not; the sentence says where"},
            {verdict_kind::no_difference, "No difference", "every primary ratio lies within the band"},
            {verdict_kind::does_not_hold, "Does not hold", "no primary ratio favours it, and one speaks against it"},
            {verdict_kind::undecided, "Undecided",
             "the direction of a primary ratio is open, and the verdict hangs on it"}};
}

table rule_table() {
    table t{{{"verdict", false}, {"when", false}}, {}};
    for (const auto& [kind, word, meaning] : verdict_words())
        t.rows.push_back({std::string(word), std::string(meaning)});
    return t;
}

std::vector<std::string> rule_paragraphs() {
    std::vector<std::string> all;
    std::istringstream text{std::string(embedded::rule_md)};
    bool new_paragraph = true;
    for (std::string line; std::getline(text, line);) {
        if (line.empty())
            new_paragraph = true;
        else if (std::exchange(new_paragraph, false))
            all.push_back(line);
        else
            all.back() += " " + line;
    }
    return all;
}

}  // namespace aabblab
