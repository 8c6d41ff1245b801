/// Stepping in time through detection: bodies that push each other where their meshes were found to intersect.
export module aabblab.stepping;

import aabb.std;

export import :contact_law;
export import :dynamics;
