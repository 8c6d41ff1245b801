module aabblab.checking;

import :comparison;

namespace aabblab {

std::uint64_t check_result::false_positives() const {
    std::uint64_t sum = 0;
    for (const wrong_frame& f : frames) sum += f.false_positives;
    return sum;
}

/// Finds the rows of each frame; they are ordered by frame first, unless the list is.
list_comparison::list_comparison(const pair_list& list, const list_extent& of)
    : of_(of), list_(list.rows), is_by_frame_(list.is_by_frame), begins_(of.frames + 1), explanation_(of) {
    if (is_by_frame_) {
        for (std::size_t frame = 0; frame < begins_.size(); ++frame)
            begins_[frame] = static_cast<std::size_t>(std::ranges::lower_bound(list_, frame, {}, &listed_pair::frame) -
                                                      list_.begin());
    } else {
        for (const listed_pair& row : list_)
            if (row.frame < of.frames) ++begins_[row.frame + 1];
        std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
        pairs_.resize(begins_.back());
        std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
        for (const listed_pair& row : list_)
            if (row.frame < of.frames) pairs_[next[row.frame]++] = pair_of(row);
    }
    result_.listed = list.rows.size();
    result_.unknown_frames = list.rows.size() - begins_.back();
}

/// The pair of a row, with its ids in order if they may be exchanged.
aabb::index_pair list_comparison::pair_of(const listed_pair& row) const {
    const auto [a, b] = row.pair;
    return of_.is_symmetric ? aabb::index_pair{std::min(a, b), std::max(a, b)} : row.pair;
}

/// Whether sorted rows are pairs that the scene can have, each once.
bool list_comparison::are_pairs(std::span<const aabb::index_pair> rows) const {
    bool holds = true;
    for (const auto [a, b] : rows)  // without branches, so that the loop is vectorised
        holds &= (a < of_.ids_a) & (b < of_.ids_b) & ((a != b) | !of_.is_symmetric);
    for (std::size_t i = 1; i < rows.size(); ++i) holds &= key_of(rows[i - 1]) != key_of(rows[i]);
    return holds;
}

/// Sorts the rows of the frame, and counts those that are not pairs of the scene, or repeat one.
void list_comparison::take_frame() {
    const std::size_t begin = begins_[frame_], count = begins_[frame_ + 1] - begin;
    if (is_by_frame_) {
        pairs_.resize(count);
        std::ranges::transform(list_.subspan(begin, count), pairs_.begin(),
                               [this](const listed_pair& row) { return pair_of(row); });
    }
    rows_ = is_by_frame_ ? std::span(pairs_) : std::span(pairs_).subspan(begin, count);
    if (!std::ranges::is_sorted(rows_, {}, key_of)) sorter_.sort(rows_);
    listed_ = rows_;
    if (are_pairs(rows_)) return;
    accepted_.clear();
    for (const aabb::index_pair& row : rows_) {
        if (row.a >= of_.ids_a || row.b >= of_.ids_b)
            ++result_.unknown_ids;
        else if (of_.is_symmetric && row.a == row.b)
            ++result_.self_pairs;
        else if (!accepted_.empty() && accepted_.back() == row)
            ++result_.duplicates;
        else
            accepted_.push_back(row);
    }
    listed_ = accepted_;
}

/// Compares two sorted lists.
/// @returns the wrong pairs, in buffers that only grow
frame_errors list_comparison::find_errors(std::span<const aabb::index_pair> truth) {
    if (false_negatives_.size() < truth.size()) false_negatives_.resize(truth.size());
    if (false_positives_.size() < listed_.size()) false_positives_.resize(listed_.size());
    auto listed = listed_.begin();
    auto false_negative = false_negatives_.begin();
    auto false_positive = false_positives_.begin();
    for (const aabb::index_pair& pair : truth) {
        for (; listed != listed_.end() && key_of(*listed) < key_of(pair); ++listed) *false_positive++ = *listed;
        if (listed != listed_.end() && *listed == pair)
            ++listed;
        else
            *false_negative++ = pair;
    }
    false_positive = std::copy(listed, listed_.end(), false_positive);
    return {frame_, {false_negatives_.begin(), false_negative}, {false_positives_.begin(), false_positive}};
}

void list_comparison::compare(std::span<const aabb::index_pair> truth, const observer& on_errors) {
    take_frame();
    result_.expected += truth.size();
    result_.correct += truth.size();
    const bool is_wrong = !are_equal(listed_, truth);
    if (is_wrong) {
        const frame_errors errors = find_errors(truth);
        result_.correct -= errors.false_negatives.size();
        result_.frames.push_back({frame_, errors.false_negatives.size(), errors.false_positives.size()});
        on_errors(errors);
    }
    explanation_.add({.truth = truth, .rows = rows_, .listed = listed_, .is_wrong = is_wrong});
    ++frame_;
}

check_result list_comparison::result(std::vector<std::string> common) const {
    check_result result = result_;
    if (std::string sentence = explanation_.reason(result); !sentence.empty()) {
        result.patterns.push_back(std::move(sentence));
    } else {
        if (result.listed == 0)
            result.patterns.emplace_back("The list is empty.");
        else if (std::string lacking = explanation_.lacking_frames(); !lacking.empty())
            result.patterns.push_back(std::move(lacking));
        result.patterns.insert(result.patterns.end(), common.begin(), common.end());
        if (std::string growth = explanation_.growth(result); result.patterns.empty() && !growth.empty())
            result.patterns.push_back(std::move(growth));
    }
    if (result.duplicates > 0 && result.duplicates == result.correct)
        result.patterns.emplace_back("Every pair is listed twice.");
    return result;
}

}  // namespace aabblab
