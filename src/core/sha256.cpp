#include <sunfleck/core/sha256.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace sunfleck {

namespace {

/// First 32 bits of the fractional part of a root of the first primes (FIPS 180-4, 4.2.2 and 5.3.3), found in integers.
template <std::size_t N>
std::array<std::uint32_t, N> root_fractions(int degree) {
  std::array<std::uint32_t, N> out{};
  std::uint64_t prime = 1;
  for (auto& word : out) {
    bool composite = true;
    while (composite) {
      ++prime;
      composite = false;
      for (std::uint64_t d = 2; d * d <= prime; ++d) composite = composite || prime % d == 0;
    }
    const long double root = degree == 2 ? std::sqrt(static_cast<long double>(prime)) : std::cbrt(static_cast<long double>(prime));
    word = static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L);
  }
  return out;
}

}  // namespace

std::string sha256_hex(std::string_view bytes) {
  static const auto k = root_fractions<64>(3);
  auto h = root_fractions<8>(2);

  std::string message(bytes);
  message += '\x80';
  while (message.size() % 64 != 56) message += '\0';
  for (int shift = 56; shift >= 0; shift -= 8) message += static_cast<char>((static_cast<std::uint64_t>(bytes.size()) * 8) >> shift);

  for (std::size_t block = 0; block < message.size(); block += 64) {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 64; ++i) w[i / 4] = w[i / 4] << 8 | static_cast<unsigned char>(message[block + i]);
    for (std::size_t i = 16; i < 64; ++i) {
      const auto s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ (w[i - 15] >> 3);
      const auto s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ (w[i - 2] >> 10);
      w[i] = w[i - 16] + s0 + w[i - 7] + s1;
    }
    auto v = h;
    for (std::size_t i = 0; i < 64; ++i) {
      const auto s1 = std::rotr(v[4], 6) ^ std::rotr(v[4], 11) ^ std::rotr(v[4], 25);
      const auto t1 = v[7] + s1 + ((v[4] & v[5]) ^ (~v[4] & v[6])) + k[i] + w[i];
      const auto s0 = std::rotr(v[0], 2) ^ std::rotr(v[0], 13) ^ std::rotr(v[0], 22);
      const auto t2 = s0 + ((v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]));
      v = {t1 + t2, v[0], v[1], v[2], v[3] + t1, v[4], v[5], v[6]};
    }
    for (std::size_t i = 0; i < 8; ++i) h[i] += v[i];
  }
  std::string hex;
  for (const auto word : h)
    for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[(word >> shift) & 15u];
  return hex;
}

}  // namespace sunfleck
