module aabblab.checking;

import :comparison;
import :pair_sort;

namespace aabblab {

std::uint64_t check_result::false_positives() const {
    std::uint64_t sum = 0;
    for (const wrong_frame& f : frames) sum += f.false_positives;
    return sum;
}

/// Orders the rows by frame, and sorts out those that no frame has.
list_comparison::list_comparison(const pair_list& list, const list_extent& of)
    : of_(of), begins_(of.frames + 1), explanation_(of) {
    const auto pair_of = [&](const listed_pair& row) {
        return of.is_symmetric ? aabb::ordered_pair(row.pair.a, row.pair.b) : row.pair;
    };
    if (std::ranges::is_sorted(list.rows, {}, &listed_pair::frame)) {
        for (std::size_t frame = 0; frame < begins_.size(); ++frame)
            begins_[frame] = static_cast<std::size_t>(
                std::ranges::lower_bound(list.rows, frame, {}, &listed_pair::frame) - list.rows.begin());
        pairs_.reserve(begins_.back());
        for (const listed_pair& row : std::span(list.rows).first(begins_.back())) pairs_.push_back(pair_of(row));
    } else {
        for (const listed_pair& row : list.rows)
            if (row.frame < of.frames) ++begins_[row.frame + 1];
        std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
        pairs_.resize(begins_.back());
        std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
        for (const listed_pair& row : list.rows)
            if (row.frame < of.frames) pairs_[next[row.frame]++] = pair_of(row);
    }
    result_.listed = list.rows.size();
    result_.unknown_frames = list.rows.size() - pairs_.size();
}

/// Whether sorted rows are pairs that the scene can have, each once.
bool list_comparison::are_pairs(std::span<const aabb::index_pair> rows) const {
    bool holds = true;
    for (std::size_t i = 0; i < rows.size(); ++i)
        holds &= rows[i].a < of_.ids_a && rows[i].b < of_.ids_b && !(of_.is_symmetric && rows[i].a == rows[i].b) &&
                 !(i > 0 && rows[i] == rows[i - 1]);
    return holds;
}

/// Sorts the rows of the frame, and counts those that are not pairs of the scene, or repeat one.
void list_comparison::take_frame() {
    rows_ = std::span(pairs_).subspan(begins_[frame_], begins_[frame_ + 1] - begins_[frame_]);
    if (!std::ranges::is_sorted(rows_)) sort_pairs(rows_, std::max(of_.ids_a, of_.ids_b));
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
void list_comparison::find_errors(std::span<const aabb::index_pair> truth) {
    false_negatives_.clear();
    false_positives_.clear();
    auto listed = listed_.begin();
    for (const aabb::index_pair& pair : truth) {
        for (; listed != listed_.end() && *listed < pair; ++listed) false_positives_.push_back(*listed);
        if (listed != listed_.end() && *listed == pair)
            ++listed;
        else
            false_negatives_.push_back(pair);
    }
    false_positives_.insert(false_positives_.end(), listed, listed_.end());
}

void list_comparison::compare(std::span<const aabb::index_pair> truth, const observer& on_errors) {
    take_frame();
    result_.expected += truth.size();
    result_.correct += truth.size();
    const bool is_wrong = !std::ranges::equal(listed_, truth);
    if (is_wrong) {
        find_errors(truth);
        result_.correct -= false_negatives_.size();
        result_.frames.push_back({frame_, false_negatives_.size(), false_positives_.size()});
        on_errors({frame_, false_negatives_, false_positives_});
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
