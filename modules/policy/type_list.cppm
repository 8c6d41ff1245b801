export module aabb.policy:type_list;

export namespace aabb {

/// A list of types, for registries.
template <class... Types>
struct type_list {};

}  // namespace aabb
