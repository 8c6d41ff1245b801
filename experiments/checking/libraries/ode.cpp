// Pairs by ODE: boxes in a hash space whose near pairs `dCollide` tests, and two trimeshes, whose contacts name their
// triangles.
#include <ode/ode.h>

#include <set>

#include "exchange.hpp"

namespace {

/// Stores the geometries of a near pair if they have a contact.
void collide_boxes(void* data, dGeomID a, dGeomID b) {
    std::array<dContactGeom, 8> contacts{};
    if (dCollide(a, b, static_cast<int>(contacts.size()), contacts.data(), sizeof(dContactGeom)) == 0) return;
    const auto id = [](dGeomID geom) { return *static_cast<const std::size_t*>(dGeomGetData(geom)); };
    static_cast<std::vector<std::array<std::size_t, 2>>*>(data)->push_back({id(a), id(b)});
}

void find_boxes(const std::vector<std::vector<lists::box>>& frames, lists::pair_file& out) {
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        const std::vector<lists::box>& boxes = frames[frame];
        std::vector<std::size_t> ids(boxes.size());
        const dSpaceID space = dHashSpaceCreate(nullptr);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const auto& [min, max] = boxes[i];
            const auto side = [&](std::size_t k) { return dReal{max[k]} - dReal{min[k]}; };
            const auto centre = [&](std::size_t k) { return (dReal{min[k]} + dReal{max[k]}) / 2; };
            const dGeomID geom = dCreateBox(space, side(0), side(1), side(2));
            dGeomSetPosition(geom, centre(0), centre(1), centre(2));
            ids[i] = i;
            dGeomSetData(geom, &ids[i]);
        }
        std::vector<std::array<std::size_t, 2>> pairs;
        dSpaceCollide(space, &pairs, collide_boxes);
        for (const auto& [a, b] : pairs) out.add(frame, a, b);
        dSpaceDestroy(space);  // and its geometries
    }
}

/// A mesh in the layout that ODE reads, and its geometry.
class trimesh {
public:
    explicit trimesh(const lists::mesh& m) : vertices_(m.vertices), data_(dGeomTriMeshDataCreate()) {
        for (const auto& t : m.triangles)
            for (const int corner : t) indices_.push_back(static_cast<dTriIndex>(corner));
        dGeomTriMeshDataBuildDouble(data_, vertices_.data(), static_cast<int>(sizeof vertices_[0]),
                                    static_cast<int>(vertices_.size()), indices_.data(),
                                    static_cast<int>(indices_.size()), static_cast<int>(3 * sizeof(dTriIndex)));
        geom_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    }
    trimesh(const trimesh&) = delete;
    trimesh& operator=(const trimesh&) = delete;
    ~trimesh() {
        dGeomDestroy(geom_);
        dGeomTriMeshDataDestroy(data_);
    }

    [[nodiscard]] dGeomID get() const { return geom_; }

private:
    std::vector<std::array<double, 3>> vertices_;
    std::vector<dTriIndex> indices_;
    dTriMeshDataID data_;
    dGeomID geom_ = nullptr;
};

void find_triangles(const lists::mesh& a, const lists::mesh& b, lists::pair_file& out) {
    constexpr int most_contacts = 0xffff;  // ODE's limit
    const trimesh mesh_a(a), mesh_b(b);
    std::vector<dContactGeom> contacts(most_contacts);
    const int count = dCollide(mesh_a.get(), mesh_b.get(), most_contacts, contacts.data(), sizeof(dContactGeom));
    // A pair of triangles has a contact per point.
    std::set<std::array<int, 2>> pairs;
    for (int i = 0; i < count; ++i) {
        const dContactGeom& c = contacts[static_cast<std::size_t>(i)];
        pairs.insert(c.g1 == mesh_a.get() ? std::array{c.side1, c.side2} : std::array{c.side2, c.side1});
    }
    for (const auto& [s, t] : pairs) out.add(s, t);  // -1 where ODE names no triangle
}

}  // namespace

int main(int count, char** values) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    const int status = lists::run(count, values, "ODE " dODE_VERSION, find_boxes, find_triangles);
    dCloseODE();
    return status;
}
