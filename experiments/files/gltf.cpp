module;
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

module aabblab.files;

import aabb;
import :file_text;
import :mesh_builder;
import :readers;

namespace aabblab {

namespace {

/// Adds the meshes of a node, moved to where the node stands, then those of its children: the order of the file.
void add_node(mesh_builder& mesh, const file_text& file, const aiScene& scene, const aiNode& node,
              const aiMatrix4x4& parent) {
    const aiMatrix4x4 place = parent * node.mTransformation;
    std::vector<std::uint32_t> corners;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
        const auto first = static_cast<std::uint32_t>(mesh.vertices());
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D moved = place * part.mVertices[v];
            const aabb::vec3f p{moved.x, moved.y, moved.z};
            if (!aabb::is_finite(p))
                throw aabb::input_error(file.name + ": vertex " + std::to_string(mesh.vertices()) +
                                        " has a coordinate that is not finite");
            mesh.add_vertex(p);
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            corners.clear();
            for (unsigned i = 0; i < face.mNumIndices; ++i) corners.push_back(first + face.mIndices[i]);
            mesh.add_face(corners, f);
        }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) add_node(mesh, file, scene, *node.mChildren[c], place);
}

}  // namespace

loaded_mesh read_gltf(const file_text& file) {
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(file.name, aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw aabb::input_error(file.name + ": is no glTF file that can be read: " + importer.GetErrorString());
    mesh_builder mesh(file.name);
    add_node(mesh, file, *scene, *scene->mRootNode, aiMatrix4x4());
    return mesh.finish(0, file.name + ": face ", 0);
}

}  // namespace aabblab
