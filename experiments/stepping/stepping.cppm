/// Time integration with collision detection: contact forces act on bodies whose meshes are found to intersect.
export module aabblab.stepping;

import aabb.std;

export import :contact_law;
export import :dynamics;
export import :rotation;
