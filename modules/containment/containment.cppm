/// What lies inside what: connected components of surfaces, whether they are closed, and which of them enclose a mesh.
export module aabb.containment;

export import aabb.local_detection;
import aabb.std;

export import :components;
export import :enclosure;
export import :parity_ray;
