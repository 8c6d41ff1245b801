module;
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "rule_md.hpp"

module aabblab.reproduction;

namespace aabblab {

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
