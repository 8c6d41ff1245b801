module aabblab.record;

import aabb.base;

namespace aabblab {

source_list::source_list(std::span<const std::string> names) {
    for (const std::string& name : names) {
        if (!std::filesystem::exists(name)) throw aabb::input_error(name + " is not there");
        all_.push_back({name, std::filesystem::is_directory(name) ? std::filesystem::path(name)
                                                                  : unpacked_.emplace_back(name, record_top).folder()});
    }
}

void source_list::add(const std::filesystem::path& folder) {
    all_.push_back({folder.string(), folder});
}

int source_list::with_names_of_user(const std::function<int()>& work) const {
    try {
        return work();
    } catch (const aabb::input_error& refused) {
        std::string sentence = refused.what();
        for (const results_source& source : all_)
            if (const std::size_t at = sentence.find(source.folder.string()); at != std::string::npos)
                sentence.replace(at, source.folder.string().size(), source.name);
        throw aabb::input_error(sentence);
    }
}

}  // namespace aabblab
