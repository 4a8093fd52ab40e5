// What a TransportStore holds.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sunfleck/radiosity/transport_store.hpp>
#include <sunfleck/visibility/projection.hpp>

#include "cluster_tree.hpp"
#include "line_links.hpp"

namespace sunfleck {

struct StoredTransport {
  Elements elements;  ///< without the order of organs
  std::optional<ClusterTree> tree;
  LineLinks links;     ///< with lines of direct light
  double seconds = 0;  ///< that it took to make

  std::size_t bytes() const { return elements.bytes() + (tree ? tree->bytes() : 0) + links.bytes(); }
};

class TransportStore::Entries {
 public:
  explicit Entries(TransportStore& store) : store_(store) {}

  /// Null if there is none.
  std::shared_ptr<const StoredTransport> find(const std::string& key);
  void keep(const std::string& key, std::shared_ptr<const StoredTransport> transport);
  /// Would lines of so many elements fit? By what they are expected to meet.
  bool has_room(std::size_t elements, const RadiosityDensity& density) const;
  std::uint64_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::shared_ptr<const StoredTransport> transport;
    std::uint64_t bytes = 0, used = 0;
  };
  TransportStore& store_;
  std::map<std::string, Entry> entries_;
  std::uint64_t bytes_ = 0, clock_ = 0;
};

}  // namespace sunfleck
