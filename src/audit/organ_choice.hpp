// Fewer organs than were chosen at first.
#pragma once

#include <sunfleck/audit/certificate.hpp>

namespace sunfleck {

/// Where the seed of the certificate's own numbers comes from.
std::uint64_t certificate_seed(const CertificateSettings& settings);

/// Draws `wanted` of them by the same rule; shares stay those of the whole scene.
std::vector<ChosenOrgan> choose_fewer(const std::vector<ChosenOrgan>& chosen, std::uint32_t wanted, const CertificateSettings& settings);

}  // namespace sunfleck
