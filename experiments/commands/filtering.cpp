#include "command_parser.hpp"

#include "filtering.hpp"

import aabblab.inputs;

namespace aabblab {

void add_filter_options(const command_parser& command, filter_files* files) {
    command.option("--groups FILE", &files->groups,
                   "CSV file of collision groups: a header with object and any of group, mask (32 bits: a pair is kept "
                   "if each one's group is in the other's mask), set (a or b: only pairs of both sets are kept) and "
                   "rest (1: not paired with others at rest)");
    command.option("--except FILE", &files->except, "CSV file of pairs of objects to leave out, with the header a,b");
}

void require_no_filter(const std::string& out, const filter_files& files) {
    for (const std::optional<std::string>& file : {files.groups, files.except})
        if (file) require_other_file(out, *file);
}

std::string filter_text(const filter_files& files) {
    return files.any() ? ", filtered by " + visible(files.text()) : "";
}

}  // namespace aabblab
