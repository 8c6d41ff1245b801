module;
#include <ode/ode.h>

module aabb.engines;

import :box_engine;
import :engine;

namespace aabb {

namespace {

/// A box in ODE's layout: the lower and the upper end for each axis.
struct ode_box {
    std::array<dReal, 6> ends;
    std::uint32_t id;
};

ode_box& data_of(dGeomID geom) {
    return *static_cast<ode_box*>(dGeomGetClassData(geom));
}

/// A geometry class that keeps our exact boxes: for its own classes, ODE would compute boxes with rounding. ODE
/// supports few classes and keeps them for the lifetime of the process.
int class_of_boxes() {
    static const int box_class = [] {
        if (!dInitODE2(0) || !dAllocateODEDataForThread(dAllocateMaskAll)) throw std::bad_alloc();
        dGeomClass boxes{};
        boxes.bytes = sizeof(ode_box);
        boxes.collider = [](int) -> dColliderFn* { return nullptr; };
        boxes.aabb = [](dGeomID geom, dReal* ends) { std::ranges::copy(data_of(geom).ends, ends); };
        return dCreateGeomClass(&boxes);
    }();
    return box_class;
}

struct release {
    void operator()(dGeomID geom) const { dGeomDestroy(geom); }
    void operator()(dSpaceID space) const { dSpaceDestroy(space); }
};
using space_handle = std::unique_ptr<dxSpace, release>;

/// Boxes in one of ODE's spaces, which compares them exactly, in double.
class ode_boxes : public box_engine {
public:
    /// @param unit scales the coordinates for ODE; a power of two, so that scaling is exact.
    explicit ode_boxes(dReal unit) : unit_(unit) {}

    /// Counts position, rotation, box and our data, but not ODE's other members, whose size is not public.
    [[nodiscard]] std::vector<part_bytes> bytes() const final {
        constexpr std::size_t per_box = sizeof(dVector3) + sizeof(dMatrix3) + 6 * sizeof(dReal) + sizeof(ode_box);
        const std::size_t boxes = space_ ? static_cast<std::size_t>(dSpaceGetNumGeoms(space_.get())) : 0;
        return {{"engine", bytes_of(boxes_, geoms_) + boxes * per_box}};
    }

protected:
    /// Makes an empty space for boxes like these.
    [[nodiscard]] virtual space_handle make_space(std::span<const ode_box> boxes) const = 0;
    /// Called before each search.
    virtual void prepare(dSpaceID, std::span<const ode_box>) const {}

private:
    /// Copies the present boxes into ODE's layout, times a power of two, and updates ODE's space, which searches them.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) final {
        boxes_.clear();
        for (const std::uint32_t id : ids) {
            const box& b = boxes[id];
            boxes_.push_back({{unit_ * b.min[0], unit_ * b.max[0], unit_ * b.min[1], unit_ * b.max[1], unit_ * b.min[2],
                               unit_ * b.max[2]},
                              id});
        }
        drop_absent(geoms_, [](const auto&) {});  // a geometry leaves its space when it is destroyed
        update_space();
    }

    /// Gives each present object a geometry with its box in ODE's space, and makes the space if there is none.
    void update_space() {
        if (boxes_.empty()) return;
        if (!space_) {
            space_ = make_space(boxes_);
            dSpaceSetCleanup(space_.get(), 0);  // `geoms_` owns the geometries
        }
        if (geoms_.size() <= boxes_.back().id) geoms_.resize(std::size_t{boxes_.back().id} + 1);
        for (const ode_box& entry : boxes_) {
            auto& geom = geoms_[entry.id];
            if (!geom) {
                geom.reset(dCreateGeom(class_of_boxes()));
                dSpaceAdd(space_.get(), geom.get());
            }
            data_of(geom.get()) = entry;
            // Marks the box as changed.
            dGeomSetPosition(geom.get(), 0, 0, 0);
        }
        prepare(space_.get(), boxes_);
    }

    /// Collides ODE's space with itself. After an exception ODE keeps the space locked, so the space is given up, and
    /// the next search makes a new one. The callback itself must not throw: it only records that memory ran out.
    void find_pairs(std::vector<index_pair>& pairs) final {
        if (!space_) update_space();
        if (boxes_.size() < 2) return;
        pair_collector collected{pairs};
        try {
            dSpaceCollide(space_.get(), &collected, collect);
        } catch (...) {
            leak_locked_space();
            throw;
        }
        collected.require_memory();
    }

    /// Must not throw, since ODE would stay locked.
    static void collect(void* collector, dGeomID a, dGeomID b) {
        pair_collector& collected = *static_cast<pair_collector*>(collector);
        collected.append_safely([&] { collected.pairs.push_back(ordered_pair(data_of(a).id, data_of(b).id)); });
    }

    /// A space that runs out of memory in a search stays locked, and ODE aborts the process on any further access to it
    /// or its objects. So they are leaked, and the next search creates new ones.
    void leak_locked_space() {
        // NOLINTBEGIN(bugprone-unused-return-value)
        for (auto& geom : geoms_) (void)geom.release();
        (void)space_.release();
        // NOLINTEND(bugprone-unused-return-value)
    }

    dReal unit_;
    std::vector<ode_box> boxes_;
    space_handle space_;
    std::vector<std::unique_ptr<dxGeom, release>> geoms_;  // by id, null if absent; destroyed before the space
};

/// The hashed grid, in a unit in which all cells are smaller than 1. With larger cells, ODE may store a box in one
/// place and look it up in another: it computes the first cell of a column and increments for the next ones, which
/// gives another place if the first number is negative but unsigned.
class ode_hash final : public ode_boxes {
public:
    ode_hash() : ode_boxes(dReal{0x1p-160}) {}

private:
    [[nodiscard]] space_handle make_space(std::span<const ode_box>) const override {
        return space_handle(dHashSpaceCreate(nullptr));
    }

    /// Sets the levels of the hashed grid: cells of level n have edges of 2^n, from the smallest to the largest object,
    /// but the least one is limited so that cell indices fit into an int.
    void prepare(dSpaceID space, std::span<const ode_box> boxes) const override {
        constexpr std::size_t most_boxes = (std::size_t{1} << 17) - 1;
        if (boxes.size() > most_boxes)
            throw input_error("ode_hash takes at most " + std::to_string(most_boxes) + " objects, but there are " +
                              std::to_string(boxes.size()) + ": ODE counts the bytes for their pairs in an int");
        int least_level = 0;
        int greatest_level = std::numeric_limits<int>::min();
        dReal farthest = std::numeric_limits<dReal>::min();
        for (const auto& [ends, id] : boxes) {
            for (const dReal end : ends) farthest = std::max(farthest, std::abs(end));
            const dReal extent = std::max({ends[1] - ends[0], ends[3] - ends[2], ends[5] - ends[4]});
            // Points have no size; ODE compares each with all boxes.
            if (extent == 0) continue;
            least_level = std::min(least_level, level_of(extent));
            greatest_level = std::max(greatest_level, level_of(extent));
        }
        least_level = std::max(least_level, level_of(farthest) - 30);  // indices below 2^30
        dHashSpaceSetLevels(space, least_level, std::max(least_level, greatest_level));
    }

    /// The level of the smallest cells, of edge 2^level, that are larger than the extent.
    static int level_of(dReal extent) { return std::ilogb(extent) + 1; }
};

class ode_sap final : public ode_boxes {
public:
    ode_sap() : ode_boxes(1) {}

private:
    /// Makes a space that sweeps along the axis on which the boxes' lower ends have the greatest range.
    [[nodiscard]] space_handle make_space(std::span<const ode_box> boxes) const override {
        std::array<dReal, 3> extents{};
        std::array<std::size_t, 3> axes = {0, 1, 2};
        for (const std::size_t axis : axes) {
            const auto lower_end = [&](const ode_box& entry) { return entry.ends[2 * axis]; };
            const auto [first, last] = std::ranges::minmax_element(boxes, {}, lower_end);
            extents[axis] = lower_end(*last) - lower_end(*first);
        }
        std::ranges::stable_sort(axes, std::greater(), [&](std::size_t axis) { return extents[axis]; });
        const auto order = static_cast<int>(axes[0] | axes[1] << 2 | axes[2] << 4);  // ODE's code for an order of axes
        return space_handle(dSweepAndPruneSpaceCreate(nullptr, order));
    }
};

}  // namespace

engine ode_hash_engine() {
    return {.name = "ode_hash",
            .summary = "ODE's hashed grid with cells of several sizes; a bit per pair limits it to 131,071 boxes",
            .boxes = make_stage<global_stage, ode_hash>};
}

engine ode_sap_engine() {
    return {.name = "ode_sap",
            .summary = "ODE's sweep along one axis, radix-sorted in each frame",
            .boxes = make_stage<global_stage, ode_sap>};
}

}  // namespace aabb
