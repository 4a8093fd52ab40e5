// One libFuzzer program per parser: SUNFLECK_FUZZ_FORMAT names it.
#include "fuzz/formats.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string format = SUNFLECK_FUZZ_FORMAT;
  sunfleck::fuzz::feed(format, {data, size});
  return 0;
}
