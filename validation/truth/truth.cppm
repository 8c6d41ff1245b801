/// Why another answer may differ from the exact one. No header of CGAL reaches an importer.
export module aabb.truth;

export import :differences;
