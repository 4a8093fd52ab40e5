// Operators of originals that are kept from solve to solve, in memory and on disk.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace sunfleck {

/// What an original does with light follows from its geometry, its optics, the densities and the seed alone: its elements, its links along
/// lines, where lines leave it. A store keeps that by a key of just these, so that a solve of another scene, or under another light, that
/// has an original with the same key takes it as it is: with the same bits as if it had been traced.
///
/// In memory those that were not used for longest go first. On disk one file an entry, KEY.operator, complete or absent, with a checksum:
/// what does not fit is traced anew. For one solve at a time.
class OperatorStore {
 public:
  /// At most so many bytes in memory, and as many in `folder`; an empty folder name: nothing on disk.
  explicit OperatorStore(std::uint64_t most_bytes = std::uint64_t{1} << 30, std::string folder = {});
  ~OperatorStore();
  OperatorStore(const OperatorStore&) = delete;
  OperatorStore& operator=(const OperatorStore&) = delete;

  /// Since the last call of start().
  struct Use {
    std::uint64_t found = 0, read = 0, made = 0;  ///< operators: from memory, from disk, traced
    double saved_seconds = 0;                     ///< that tracing what was found and read took when it was made
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
