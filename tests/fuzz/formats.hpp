// What the fuzzers and the replay of their corpus feed: one entry per parser.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunfleck::fuzz {

/// Names of the parsers, which are the folders of tests/hostile/corpus too.
const std::vector<std::string>& formats();

/// Lets a parser read these bytes. Returns whether they were accepted; an InputError is the other proper end, or a
/// UsageError where the file leaves a choice to the options. Anything else (another
/// exception, a crash, a hang) is a finding.
bool feed(const std::string& format, std::span<const std::uint8_t> bytes);

}  // namespace sunfleck::fuzz
