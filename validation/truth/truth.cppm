/// The exact answer on a scene, and why another may differ from it. No header of CGAL reaches an importer.
export module aabb.truth;

import aabb.std;

export import :differences;
export import :exact_answer;
