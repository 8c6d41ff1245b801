/// Points, triangles, boxes, meshes and poses, and predicates on their coordinates.
export module aabb.geometry;

export import aabb.base;
import aabb.std;

export import :box;
export import :boxd;
export import :corner_terms;
export import :exact_products;
export import :float_boxes;
export import :index_pair;
export import :intersection;
export import :mesh;
export import :pose;
export import :posed_orientations;
export import :predicates;
export import :product_sum;
export import :triangle_box;
export import :points;
export import :vertex_frame;
