module aabblab.checking;

import :explanation;
import :pair_order;
import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

using aabb::index_pair;

/// Whether the rows, each once and moved, are the ground truth.
/// @param moved the pair that a row stands for
template <class Moved>
bool are_moved(const compared_frame& frame, const list_extent& of, Moved moved) {
    if (frame.rows.size() < frame.truth.size()) return false;
    const auto pair_of = [&](const index_pair& row) {
        index_pair pair = moved(row);
        if (of.is_symmetric && pair.a > pair.b) std::swap(pair.a, pair.b);
        return pair;
    };
    // Of most lists that are not moved, a few rows show it.
    for (const std::size_t place : {std::size_t{0}, frame.rows.size() / 2, frame.rows.size() - 1})
        if (!frame.rows.empty() && !std::ranges::binary_search(frame.truth, pair_of(frame.rows[place]))) return false;
    std::vector<index_pair> pairs;
    pairs.reserve(frame.rows.size());
    for (const index_pair& row : frame.rows) pairs.push_back(pair_of(row));
    pair_sorter().sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    return are_equal(pairs, frame.truth);
}

/// The same for rows with 1 taken from each id, which keeps their order.
bool are_from_one(const compared_frame& frame) {
    auto pair = frame.truth.begin();
    for (std::size_t i = 0; i < frame.rows.size(); ++i) {
        const auto [a, b] = frame.rows[i];
        if (i > 0 && frame.rows[i] == frame.rows[i - 1]) continue;
        if (pair == frame.truth.end() || *pair != index_pair{a - 1, b - 1}) return false;
        ++pair;
    }
    return pair == frame.truth.end();
}

std::uint32_t exchanged_id(std::uint32_t id, index_pair objects) {
    return id == objects.a ? objects.b : id == objects.b ? objects.a : id;
}

/// Whether the list of the frame is right with the ids of two objects exchanged.
bool is_exchanged(const compared_frame& frame, const list_extent& of, index_pair objects) {
    return are_moved(frame, of, [objects](index_pair row) {
        return index_pair{exchanged_id(row.a, objects), exchanged_id(row.b, objects)};
    });
}

/// Every two objects whose exchange makes a wrong frame right. The first false positive u,v then stands for a false
/// negative with u or v in it, whose other object is one of the two.
std::vector<index_pair> exchanges_in(const compared_frame& frame, const list_extent& of) {
    constexpr std::size_t most_tried = 16;
    std::vector<index_pair> exchanges;
    if (frame.listed.size() != frame.truth.size()) return exchanges;
    std::vector<index_pair> false_positives, false_negatives;
    std::ranges::set_difference(frame.listed, frame.truth, std::back_inserter(false_positives));
    std::ranges::set_difference(frame.truth, frame.listed, std::back_inserter(false_negatives));
    const auto [u, v] = false_positives.front();
    std::size_t tried = 0;
    for (const index_pair& lost : false_negatives)
        for (const auto [kept, moved] : {index_pair{u, v}, index_pair{v, u}}) {
            if ((lost.a != kept && lost.b != kept) || tried++ == most_tried) continue;
            const index_pair objects = aabb::ordered_pair(moved, lost.a == kept ? lost.b : lost.a);
            if (is_exchanged(frame, of, objects)) exchanges.push_back(objects);
        }
    return exchanges;
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

/// Tests whether other ids make the list right. Ids that are all moved explain a right frame only if it has no pairs.
void list_explanation::test_ids(const compared_frame& frame) {
    const auto test = [&](hypothesis& h, const auto& explains) {
        if (!h.holds) return;
        h.holds = frame.is_wrong ? explains() : frame.truth.empty();
        h.frames += h.holds && frame.is_wrong;
    };
    test(from_one_, [&] { return are_from_one(frame); });
    // The id -1 is `beyond_all`, and becomes 0.
    test(from_minus_one_,
         [&] { return are_moved(frame, of_, [](index_pair row) { return index_pair{row.a + 1, row.b + 1}; }); });
    test(reversed_, [&] {
        return !of_.is_symmetric && are_moved(frame, of_, [](index_pair row) { return index_pair{row.b, row.a}; });
    });
    test(mirrored_, [&] {
        const auto last_a = static_cast<std::uint32_t>(of_.ids_a - 1),
                   last_b = static_cast<std::uint32_t>(of_.ids_b - 1);
        return are_moved(frame, of_,
                         [last_a, last_b](index_pair row) { return index_pair{last_a - row.a, last_b - row.b}; });
    });
    if (!of_.is_symmetric) return;
    if (exchanges_)
        std::erase_if(*exchanges_, [&](index_pair objects) { return !is_exchanged(frame, of_, objects); });
    else if (frame.is_wrong)
        exchanges_ = exchanges_in(frame, of_);
}

/// Tests whether the list is right in other frames.
void list_explanation::test_order(const compared_frame& frame) {
    is_early_ &= frame_ == 0 || are_equal(previous_list_, frame.truth);
    if (!frame.is_wrong) return;
    const auto test = [&](hypothesis& h, const auto& explains) {
        h.holds = h.holds && explains();
        h.frames += h.holds;
    };
    test(late_, [&] { return frame_ == 0 ? frame.rows.empty() : are_equal(frame.listed, previous_truth_); });
    test(constant_, [&] { return frame_ > 0 && !frame.listed.empty() && are_equal(frame.listed, previous_list_); });
}

void list_explanation::add(const compared_frame& frame) {
    test_ids(frame);
    test_order(frame);
    has_early_rows_ |= frame_ == 0 && !frame.rows.empty();
    has_later_pairs_ |= frame_ > 0 && !frame.truth.empty();
    if (!frame.rows.empty()) {
        last_listed_ = frame_;
        truth_after_last_ = 0;
    } else {
        truth_after_last_ += frame.truth.size();
        if (!frame.truth.empty()) lacking_.push_back(frame_);
        lacking_pairs_ += frame.truth.size();
    }
    if (late_.holds) previous_truth_.assign(frame.truth.begin(), frame.truth.end());
    if (is_early_ || constant_.holds) previous_list_.assign(frame.listed.begin(), frame.listed.end());
    ++frame_;
}

std::string list_explanation::reason_of_ids(const check_result& result) const {
    const auto explains = [&](const hypothesis& h) { return h.holds && h.frames == result.frames.size(); };
    if (explains(from_one_))
        return "Ids are off by one: with 1 taken from each, the list is right. The scene counts from 0.";
    if (explains(from_minus_one_)) return "Ids are off by one: with 1 added to each, the list is right.";
    if (explains(reversed_)) return "The ids are exchanged: with b,a in place of a,b the list is right.";
    if (explains(mirrored_))
        return of_.ids_a == of_.ids_b
                   ? fmt::format("Ids are mirrored: with {} - id in place of each, the list is right.", of_.ids_a - 1)
                   : fmt::format("Ids are mirrored: with {} - a and {} - b in place of a and b, the list is right.",
                                 of_.ids_a - 1, of_.ids_b - 1);
    if (exchanges_ && !exchanges_->empty()) {
        const std::uint32_t first = result.frames.front().frame;
        return fmt::format("The ids {} and {} are exchanged{}: with each in place of the other, the list is right.",
                           exchanges_->front().a, exchanges_->front().b,
                           first == 0 ? "" : fmt::format(" from frame {} on", first));
    }
    return {};
}

std::string list_explanation::reason_of_frames(const check_result& result) const {
    const std::vector<wrong_frame>& frames = result.frames;
    const auto explains = [&](const hypothesis& h) { return h.holds && h.frames == frames.size(); };
    if (explains(late_) && !has_early_rows_ && result.unknown_frames > 0)
        return "Frames are off by one: with 1 taken from each, the list is right. The scene counts from 0.";
    // If boxes rest, every frame has the pairs of the next, so a frame before the last must be wrong.
    if (is_early_ && has_later_pairs_ && frames.front().frame + 1 < frame_)
        return result.unknown_frames > 0 ? "Frames are off by one: with 1 added to each, the list is right."
                                         : "The list is early: every frame has the pairs of the next one.";
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
    if (lacking_.size() == frames.size()) return lacking_frames() + " Its other frames are right.";
    return {};
}

std::string list_explanation::growth(const check_result& result) const {
    const std::vector<wrong_frame>& frames = result.frames;
    if (result.listed == 0 || !grows(frames, frame_ - 1)) return {};
    return fmt::format(
        "The list is right up to frame {}; then its errors grow ({}), as in a list that is kept for "
        "too long.",
        frames.front().frame - 1, growth_text(frames));
}

std::string list_explanation::reason(const check_result& result) const {
    if (result.frames.empty() || result.listed == 0) return {};
    const std::string sentence = reason_of_ids(result);
    return sentence.empty() ? reason_of_frames(result) : sentence;
}

std::string list_explanation::lacking_frames() const {
    constexpr std::size_t most_named = 8;
    if (lacking_.empty()) return {};
    const std::span named = std::span(lacking_).first(std::min(most_named, lacking_.size()));
    return fmt::format("The list has no rows of frame{} {}{}, with {}.", lacking_.size() == 1 ? "" : "s",
                       fmt::join(named, ", "),
                       lacking_.size() > most_named ? fmt::format(" and {} more", lacking_.size() - most_named) : "",
                       counted(lacking_pairs_, "pair"));
}

}  // namespace aabblab
