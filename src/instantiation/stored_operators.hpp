// What an OperatorStore holds.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include <sunfleck/core/cache_folder.hpp>
#include <sunfleck/core/timer.hpp>
#include <sunfleck/instantiation/operator_store.hpp>
#include <sunfleck/scene/content.hpp>

#include "instantiation/members.hpp"

namespace sunfleck {

/// Densities as keys have them.
void put_density(ContentKey& key, const OperatorDensity& density);

class OperatorStore::Entries {
 public:
  Entries(OperatorStore& store, std::string folder);

  /// The original of a key with its coarse operator: found, read or made. A copy of its own, which may be changed.
  OriginalLight original(const std::string& key, const std::function<OriginalLight()>& make);
  std::shared_ptr<const LineOperator> fine(const std::string& key, const std::function<std::unique_ptr<LineOperator>()>& make);
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::shared_ptr<const OriginalLight> original;  ///< one of the two
    std::shared_ptr<const LineOperator> fine;
    std::uint64_t bytes = 0, used = 0;
    double seconds = 0;  ///< that it took to make
  };
  /// Found or read; else empty.
  Entry look_up(const std::string& key, bool is_original);
  /// In memory and on disk.
  void keep(const std::string& key, Entry entry);
  void hold(const std::string& key, Entry entry);

  OperatorStore& store_;
  CacheFolder files_;
  std::map<std::string, Entry> entries_;
  std::uint64_t bytes_ = 0, clock_ = 0;
};

}  // namespace sunfleck
