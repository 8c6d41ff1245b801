module;
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

module aabblab.results;

import aabb.base;

namespace aabblab {

void make_folder(const std::filesystem::path& folder) {
    if (folder.empty()) throw aabb::input_error("the folder of the results has no name");
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw aabb::input_error("the folder " + folder.string() + " cannot be made: " + error.message());
}

folder_lock::folder_lock(const std::filesystem::path& folder) {
    make_folder(folder);
    // Processes that this one starts keep it too (no O_CLOEXEC): what they still do when this one is killed must end
    // before another begins.
    descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY);
    // A process that was killed leaves others that are about to end.
    for (int attempt = 0; attempt < 20; ++attempt) {
        // A file system that locks no folders cannot tell.
        if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
        usleep(50'000);
    }
    close(descriptor_);
    throw aabb::input_error("another aabblab writes into " + folder.string() +
                            " at this moment; wait until it ends, or name another folder with --out");
}

folder_lock::~folder_lock() {
    if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace aabblab
