module;
#include <fmt/format.h>

module aabblab.reproduction;

namespace aabblab {

std::string agreement_of(std::span<const claim_result> here, std::span<const claim_result> there,
                         const std::string& other) {
    std::string differing;
    std::size_t same = 0;
    for (const claim_result& c : here) {
        const auto counterpart = std::ranges::find(there, c.id, &claim_result::id);
        const std::string verdict = counterpart == there.end() ? "none" : text_of(*counterpart);
        if (verdict == text_of(c))
            ++same;
        else
            differing +=
                fmt::format("{} {}: here {}, there {}", differing.empty() ? ":" : ";", c.id, text_of(c), verdict);
    }
    return fmt::format("{} of {} verdicts agree with {}{}.", same, here.size(), other, differing);
}

}  // namespace aabblab
