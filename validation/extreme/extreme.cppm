/// Scenes in which exactness is hardest, pairs of triangles known to be hard, and the judge of whoever plays them.
export module aabb.extreme;

import aabb.std;

export import :arithmetic;
export import :exact_frames;
export import :judge;
export import :known_scenes;
export import :scene;
export import :triangle_case;
