/// Shows the progress of long runs on a terminal.
export module aabblab.progress;

import aabb.std;

export namespace aabblab {

/// "searching: 30 of 120, about 12 s left". The estimate assumes constant speed; it is omitted before the first step is
/// done, and if the total is unknown (0): "searching: 30".
[[nodiscard]] std::string progress_text(std::string_view what, std::size_t done, std::size_t total,
                                        std::chrono::duration<double> elapsed);

/// A progress line on stderr, shown on terminals only, and only after two seconds of work. The destructor clears the
/// line; `hide` clears it for other output until the next `update`.
class progress {
public:
    /// @param what the work, as in "searching"
    /// @param total the number of steps; 0 if unknown
    progress(std::string what, std::size_t total);
    progress(const progress&) = delete;
    progress& operator=(const progress&) = delete;
    ~progress() { hide(); }

    /// Reports that `done` steps are done. Cheap enough for steps of a millisecond.
    void update(std::size_t done);
    void hide();

private:
    using clock = std::chrono::steady_clock;

    std::string what_;
    std::size_t total_;
    clock::time_point start_ = clock::now();
    clock::time_point drawn_ = start_;
    bool on_terminal_;
    bool visible_ = false;
};

}  // namespace aabblab
