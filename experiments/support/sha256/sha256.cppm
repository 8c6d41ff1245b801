/// Checksums that users can verify with sha256sum.
export module aabblab.sha256;

import aabb.std;

export namespace aabblab {

/// SHA-256 (FIPS 180-4) in 64 hexadecimal digits, as sha256sum prints it.
[[nodiscard]] std::string sha256_of(std::string_view bytes);

}  // namespace aabblab
