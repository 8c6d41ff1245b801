/// How far long work has come, for whoever waits at a terminal.
export module aabblab.progress;

import aabb.std;

export namespace aabblab {

/// "searching: 30 of 120, about 12 s left". The estimate takes what is left to go as fast as what is done; there is
/// none before the first is done, nor where the total is not known, which is 0: "searching: 30".
[[nodiscard]] std::string progress_text(std::string_view what, std::size_t done, std::size_t total,
                                        std::chrono::duration<double> elapsed);

/// A line on stderr that says how far the work has come: on a terminal only, and only once the work has taken two
/// seconds. The line is gone when the object is; `hide` takes it away for other output until the next `at`.
class progress {
public:
    /// @param what the work, as in "searching"
    /// @param total its steps; 0 where that is not known
    progress(std::string what, std::size_t total);
    progress(const progress&) = delete;
    progress& operator=(const progress&) = delete;
    ~progress();

    /// `done` of the steps are done. Cheap enough to call for every step of a millisecond.
    void at(std::size_t done);
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
