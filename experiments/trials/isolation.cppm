/// Work that may take too long or too much memory.
export module aabblab.trials:isolation;

import aabb.std;

export namespace aabblab {

/// How work ended that was done apart.
enum class ending : std::uint8_t {
    done,
    stopped,        ///< it took longer than it may
    out_of_memory,  ///< or was killed by somebody else, as the kernel does where memory runs out
    refused,        ///< by an aabb::input_error
    failed
};

struct work_apart {
    ending end = ending::stopped;
    std::string told;    ///< up to that end
    std::string reason;  ///< the sentence of a refusal
    double seconds = 0;  ///< that it took
};

/// Takes what the work has to tell, as it comes: that is there also where the work does not end.
using telling = std::function<void(std::string_view)>;

/// Does the work in a copy of this process, which is killed after so many seconds. Where memory runs out the kernel
/// kills the copy first.
/// @param seconds without any, nothing is begun
[[nodiscard]] work_apart done_apart(const std::function<void(const telling&)>& work, double seconds);

}  // namespace aabblab
