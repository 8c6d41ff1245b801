module;
#include <openssl/evp.h>

module aabblab.sha256;

namespace aabblab {

/// The SHA-256 of the bytes, in hexadecimal.
std::string sha256_of(std::string_view bytes) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
        throw std::runtime_error("OpenSSL provides no SHA-256");
    std::string text;
    for (const unsigned char byte : std::span(digest).first(size)) {
        constexpr std::string_view digits = "0123456789abcdef";
        text += digits[byte >> 4U];
        text += digits[byte & 15U];
    }
    return text;
}

}  // namespace aabblab
