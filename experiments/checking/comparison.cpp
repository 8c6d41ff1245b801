module aabblab.checking;

import :comparison;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.pair_output;

namespace aabblab {

namespace {

/// Whether the rows, each once and moved, are the ground truth.
/// @param moved the pair that a row stands for
bool are_moved(std::span<const aabb::index_pair> rows, std::span<const aabb::index_pair> truth, bool is_symmetric,
               const std::function<aabb::index_pair(aabb::index_pair)>& moved) {
    std::vector<aabb::index_pair> pairs;
    for (const aabb::index_pair& row : rows) {
        pairs.push_back(moved(row));
        if (is_symmetric && pairs.back().a > pairs.back().b) std::swap(pairs.back().a, pairs.back().b);
    }
    sort_rows(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    return std::ranges::equal(pairs, truth);
}

/// "12 in frame 3, 40 in frame 4, 71 in frame 5"
std::string growth_text(std::span<const wrong_frame> frames) {
    std::string text;
    for (const std::size_t i : {std::size_t{0}, frames.size() / 2, frames.size() - 1})
        text += fmt::format("{}{} in frame {}", text.empty() ? "" : ", ",
                            grouped(frames[i].false_negatives + frames[i].false_positives), frames[i].frame);
    return text;
}

std::uint64_t wrong_pairs_of(std::span<const wrong_frame> frames) {
    std::uint64_t sum = 0;
    for (const wrong_frame& f : frames) sum += f.false_negatives + f.false_positives;
    return sum;
}

/// Whether wrong pairs begin after frame 0, occur in nearly all later frames, and become more.
bool grows(std::span<const wrong_frame> frames, std::uint32_t last_frame) {
    if (frames.size() < 3 || frames.front().frame == 0) return false;
    const std::size_t later = last_frame - frames.front().frame + 1;
    const std::size_t half = frames.size() / 2;
    return frames.size() >= later - later / 10 &&
           wrong_pairs_of(frames.last(half)) > wrong_pairs_of(frames.first(half)) * 5 / 4;
}

}  // namespace

std::uint64_t check_result::false_positives() const {
    std::uint64_t sum = 0;
    for (const wrong_frame& f : frames) sum += f.false_positives;
    return sum;
}

/// Orders the rows by frame, and sorts out those that no frame has.
list_comparison::list_comparison(pair_list list, const extent& of) : of_(of), begins_(of.frames + 1) {
    result_.listed = list.rows.size();
    for (listed_pair& row : list.rows) {
        if (of.is_symmetric && row.pair.a > row.pair.b) std::swap(row.pair.a, row.pair.b);
        if (row.frame >= of.frames)
            ++result_.unknown_frames;
        else
            ++begins_[row.frame + 1];
    }
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    pairs_.resize(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (const listed_pair& row : list.rows)
        if (row.frame < of.frames) pairs_[next[row.frame]++] = row.pair;
}

/// Sorts the rows of the frame, and counts those that are not pairs of the scene, or repeat one.
void list_comparison::take_frame() {
    rows_ = std::span(pairs_).subspan(begins_[frame_], begins_[frame_ + 1] - begins_[frame_]);
    if (!std::ranges::is_sorted(rows_)) sort_rows(rows_);
    listed_.clear();
    for (const aabb::index_pair& row : rows_) {
        if (row.a >= of_.ids_a || row.b >= of_.ids_b)
            ++result_.unknown_ids;
        else if (of_.is_symmetric && row.a == row.b)
            ++result_.self_pairs;
        else if (!listed_.empty() && listed_.back() == row)
            ++result_.duplicates;
        else
            listed_.push_back(row);
    }
}

/// Tests whether the errors of the list so far have one of the usual reasons.
void list_comparison::test_hypotheses(std::span<const aabb::index_pair> truth, bool is_wrong) {
    const auto test = [&](hypothesis& h, const auto& explains) {
        if (!h.holds) return;
        h.holds = explains();
        h.frames += h.holds && is_wrong;
    };
    // Ids that are moved explain a right frame only if it has no pairs.
    const auto are_moved_by = [&](std::uint32_t distance) {
        if (!is_wrong) return truth.empty();
        // The id -1 is `beyond_all`, and becomes 0.
        return are_moved(rows_, truth, of_.is_symmetric, [distance](aabb::index_pair row) {
            return aabb::index_pair{row.a + distance, row.b + distance};
        });
    };
    test(from_one_, [&] { return are_moved_by(std::numeric_limits<std::uint32_t>::max()); });
    test(from_minus_one_, [&] { return are_moved_by(1); });
    if (!is_wrong) {
        exchanged_.holds &= of_.is_symmetric || truth.empty();
        return;
    }
    test(exchanged_, [&] {
        return !of_.is_symmetric && are_moved(rows_, truth, /*is_symmetric=*/false,
                                              [](aabb::index_pair row) { return aabb::index_pair{row.b, row.a}; });
    });
    test(late_, [&] { return frame_ == 0 ? rows_.empty() : std::ranges::equal(listed_, previous_); });
    test(constant_, [&] { return frame_ > 0 && !listed_.empty() && listed_ == repeated_; });
}

void list_comparison::compare(std::span<const aabb::index_pair> truth, const observer& on_wrong_pair) {
    take_frame();
    has_early_rows_ |= frame_ == 0 && !rows_.empty();
    if (!rows_.empty()) {
        last_listed_ = frame_;
        truth_after_last_ = 0;
    } else {
        truth_after_last_ += truth.size();
    }
    result_.expected += truth.size();
    const bool is_wrong = !std::ranges::equal(listed_, truth);
    if (is_wrong) {
        wrong_frame counts{frame_};
        const auto add = [&](aabb::index_pair pair, bool is_listed) {
            ++(is_listed ? counts.false_positives : counts.false_negatives);
            on_wrong_pair({.frame = frame_, .pair = pair, .is_listed = is_listed, .description = {}, .shapes = {}});
        };
        auto listed = listed_.cbegin();
        for (const aabb::index_pair& pair : truth) {
            for (; listed != listed_.cend() && *listed < pair; ++listed) add(*listed, true);
            if (listed != listed_.cend() && *listed == pair)
                ++listed;
            else
                add(pair, false);
        }
        for (; listed != listed_.cend(); ++listed) add(*listed, true);
        result_.correct += truth.size() - counts.false_negatives;
        result_.frames.push_back(counts);
    } else {
        result_.correct += truth.size();
    }
    test_hypotheses(truth, is_wrong);
    previous_.assign(truth.begin(), truth.end());
    std::swap(repeated_, listed_);
    ++frame_;
}

/// The reason that explains every wrong frame; empty if there is none.
std::string list_comparison::reason() const {
    const std::vector<wrong_frame>& frames = result_.frames;
    if (frames.empty() || result_.listed == 0) return {};
    const auto explains = [&](const hypothesis& h) { return h.holds && h.frames == frames.size(); };
    if (explains(from_one_))
        return "Ids are off by one: with 1 taken from each, the list is right. The scene counts from 0.";
    if (explains(from_minus_one_)) return "Ids are off by one: with 1 added to each, the list is right.";
    if (explains(exchanged_)) return "The ids are exchanged: with b,a in place of a,b the list is right.";
    if (explains(late_) && !has_early_rows_ && result_.unknown_frames > 0)
        return "Frames are off by one: with 1 taken from each, the list is right. The scene counts from 0.";
    if (explains(constant_)) {
        // A right frame after a wrong one shows that the list was renewed.
        if (frames.size() == frame_ - frames.front().frame)
            return fmt::format("The list is not renewed: from frame {} on, it stays that of frame {}.",
                               frames.front().frame, frames.front().frame - 1);
        return "Every wrong frame repeats the list of the frame before, as where a list is renewed only now and then.";
    }
    if (explains(late_)) return "The list is late: every wrong frame has the pairs of the frame before.";
    if (frames.front().frame == last_listed_ + 1)
        return fmt::format("The list ends with frame {} and is right up to there; {} follow.", last_listed_,
                           counted(truth_after_last_, "pair"));
    if (grows(frames, frame_ - 1))
        return fmt::format(
            "The list is right up to frame {}; then its errors grow ({}), as in a list that is kept for "
            "too long.",
            frames.front().frame - 1, growth_text(frames));
    return {};
}

check_result list_comparison::result(std::vector<std::string> common) const {
    check_result result = result_;
    if (result.listed == 0) common.insert(common.begin(), "The list is empty.");
    if (std::string sentence = reason(); !sentence.empty())
        result.patterns.push_back(std::move(sentence));
    else
        result.patterns = std::move(common);
    if (result.duplicates > 0 && result.duplicates == result.correct)
        result.patterns.emplace_back("Every pair is listed twice.");
    return result;
}

}  // namespace aabblab
