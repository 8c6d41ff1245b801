/// The stiff suite: bodies stepped in time through detection, held against closed forms and published results.
export module aabblab.stiff;

import aabb.std;
import aabblab.trials;
export import :study;

export namespace aabblab {

/// In the order in which they are told.
[[nodiscard]] std::span<const stiff_study> stiff_studies();

/// The default composition.
[[nodiscard]] contender usual_contender();

}  // namespace aabblab
