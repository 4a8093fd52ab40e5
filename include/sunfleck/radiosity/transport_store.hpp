// How surfaces of a scene exchange light, kept from solve to solve while only what shines changes.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace sunfleck {

/// Elements, links, and which cells each sees along the lines, for methods clustering and flat: all of a solve that does not depend on the
/// light. A solve with a store takes them from there, or leaves them; its light differs from that of a solve without by the order of sums
/// alone, and not between the two. Those that were not used for longest go first. For one solve at a time.
class TransportStore {
 public:
  explicit TransportStore(std::uint64_t most_bytes = std::uint64_t{1} << 30);
  ~TransportStore();
  TransportStore(const TransportStore&) = delete;
  TransportStore& operator=(const TransportStore&) = delete;

  /// Since the last call of start().
  struct Use {
    std::uint64_t found = 0, made = 0;
    double saved_seconds = 0;  ///< that making what was found took
  };
  void start() { use_ = {}; }
  const Use& use() const { return use_; }
  std::uint64_t bytes() const;
  std::uint64_t most_bytes() const { return most_bytes_; }

  class Entries;
  Entries& entries() { return *entries_; }

 private:
  std::uint64_t most_bytes_;
  Use use_;
  std::unique_ptr<Entries> entries_;
  friend class Entries;
};

}  // namespace sunfleck
