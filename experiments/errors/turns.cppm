/// Triangle tests that take turns with batches of pairs.
module aabblab.errors:turns;

import aabb.pipeline;
import aabb.std;
import aabblab.statistics;
import aabblab.stopwatch;

namespace aabblab {

/// Each batch begins with another test, so that none always finds the cache as the same one left it.
/// @tparam Point what is found of a test
template <class Point>
class tests_in_turn {
public:
    struct one {
        Point point;
        std::unique_ptr<aabb::triangle_test> test;
        std::size_t share = 1;   ///< of how many batches it takes part in one
        std::vector<double> ns;  ///< a pair, of each batch
    };

    void add(one added) { all_.push_back(std::move(added)); }

    /// @param pairs in the batch
    /// @param work is timed, for each test
    /// @param judge follows it, untimed
    template <class Work, class Judge>
    void play(std::size_t pairs, Work work, Judge judge) {
        for (std::size_t i = 0; i < all_.size(); ++i) {
            one& turn = all_[(i + batches_) % all_.size()];
            if (batches_ % turn.share != 0) continue;
            const double ms = milliseconds_of([&] { work(*turn.test); });
            turn.ns.push_back(ms * 1e6 / static_cast<double>(pairs));
            judge(turn.point);
        }
        ++batches_;
    }

    /// @param time the member of a point that gets the quartiles of its times
    [[nodiscard]] std::vector<Point> points(quartiles Point::* time) {
        std::vector<Point> points;
        for (one& o : all_) {
            if (!o.ns.empty()) o.point.*time = quartiles_of(o.ns);
            points.push_back(std::move(o.point));
        }
        return points;
    }

private:
    std::vector<one> all_;
    std::size_t batches_ = 0;
};

}  // namespace aabblab
