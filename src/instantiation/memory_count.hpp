// Bytes that the parts of a solve hold as it goes on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sunfleck {

/// Counts what parts hold, each one's most and the most of all at one time. From one thread at a time.
class MemoryCount {
 public:
  using Rows = std::vector<std::pair<std::string, std::uint64_t>>;

  /// From now on the part holds so much.
  void hold(const std::string& part, std::uint64_t bytes) {
    Part& p = at(part);
    p.now = bytes;
    p.most = std::max(p.most, bytes);
    std::uint64_t all = 0;
    for (const auto& each : parts_) all += each.now;
    at_once_ = std::max(at_once_, all);
  }
  /// It held so much for a while, together with what all others hold now.
  void pass(const std::string& part, std::uint64_t bytes) {
    const auto before = at(part).now;
    hold(part, bytes);
    at(part).now = before;
  }
  /// The most of each part, and of all at one time as "at_once".
  Rows rows() const {
    Rows out;
    for (const auto& p : parts_) out.emplace_back(p.name, p.most);
    out.emplace_back("at_once", at_once_);
    return out;
  }

 private:
  struct Part {
    std::string name;
    std::uint64_t now = 0, most = 0;
  };
  Part& at(const std::string& name) {
    for (auto& p : parts_)
      if (p.name == name) return p;
    return parts_.emplace_back(Part{name});
  }

  std::vector<Part> parts_;
  std::uint64_t at_once_ = 0;
};

}  // namespace sunfleck
