// Pictures of the sky that a test writes for itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace sunfleck {

/// Bytes of a Radiance HDR picture in grey, not run-length encoded; `value(row, column)`. Exact for values that are eight bits times a
/// power of two.
inline std::string hdr_bytes(int columns, int rows, const std::function<double(int, int)>& value) {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(rows) + " +X " + std::to_string(columns) + "\n";
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      int exponent = 0;
      const double v = value(row, column), part = std::frexp(v, &exponent);
      const auto mantissa = static_cast<char>(static_cast<std::uint8_t>(std::lround(std::min(part * 256, 255.0))));
      // a pixel that begins like a run of the new encoding would be taken for one
      const char pixel[4] = {v > 0 ? mantissa : '\0', v > 0 ? mantissa : '\0', v > 0 ? mantissa : '\0',
                             v > 0 ? static_cast<char>(static_cast<std::uint8_t>(exponent + 128)) : '\0'};
      bytes.append(pixel, 4);
    }
  return bytes;
}

/// Bytes of a PNG picture in grey of 8 or 16 bits, stored without compression; `value(row, column)` from 0 to 2^bits - 1.
inline std::string png_bytes(int columns, int rows, int bits, const std::function<int(int, int)>& value) {
  const auto big_endian = [](std::uint32_t v) {
    std::string out;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(static_cast<std::uint8_t>(v >> shift));
    return out;
  };
  const auto crc = [](const std::string& of) {
    std::uint32_t c = 0xffffffffu;
    for (const char byte : of) {
      c ^= static_cast<std::uint8_t>(byte);
      for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    }
    return ~c;
  };
  const auto chunk = [&](const std::string& name, const std::string& data) {
    return big_endian(static_cast<std::uint32_t>(data.size())) + name + data + big_endian(crc(name + data));
  };
  std::string pixels;
  for (int row = 0; row < rows; ++row) {
    pixels += '\0';  // no filter
    for (int column = 0; column < columns; ++column) {
      const int v = value(row, column);
      if (bits == 16) pixels += static_cast<char>(static_cast<std::uint8_t>(v >> 8));
      pixels += static_cast<char>(static_cast<std::uint8_t>(v));
    }
  }
  std::string stored = "\x78\x01";
  std::uint32_t a = 1, b = 0;
  for (std::size_t at = 0; at < pixels.size(); at += 65535) {
    const std::size_t n = std::min<std::size_t>(65535, pixels.size() - at);
    stored += static_cast<char>(at + n == pixels.size());
    for (const std::size_t v : {n, ~n})
      stored += static_cast<char>(static_cast<std::uint8_t>(v)), stored += static_cast<char>(static_cast<std::uint8_t>(v >> 8));
    stored += pixels.substr(at, n);
  }
  for (const char byte : pixels) a = (a + static_cast<std::uint8_t>(byte)) % 65521, b = (b + a) % 65521;
  stored += big_endian(b << 16 | a);
  const std::string header = big_endian(static_cast<std::uint32_t>(columns)) + big_endian(static_cast<std::uint32_t>(rows)) +
                             static_cast<char>(bits) + std::string(4, '\0');
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", stored) + chunk("IEND", "");
}

}  // namespace sunfleck
