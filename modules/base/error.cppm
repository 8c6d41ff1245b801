export module aabb.base:error;

import aabb.std;

export namespace aabb {

/// Input that cannot be used: a malformed file, an unknown name, a NaN, a pose that is not rigid.
/// `what()` is one sentence for the user; the program prints it and exits with status 2.
class input_error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace aabb
