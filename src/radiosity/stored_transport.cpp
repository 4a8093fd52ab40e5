#include "stored_transport.hpp"

#include <algorithm>

namespace sunfleck {

TransportStore::TransportStore(std::uint64_t most_bytes) : most_bytes_(most_bytes), entries_(std::make_unique<Entries>(*this)) {}
TransportStore::~TransportStore() = default;

std::uint64_t TransportStore::bytes() const {
  return entries_->bytes();
}

std::shared_ptr<const StoredTransport> TransportStore::Entries::find(const std::string& key) {
  const auto at = entries_.find(key);
  if (at == entries_.end()) return nullptr;
  ++store_.use_.found;
  store_.use_.saved_seconds += at->second.transport->seconds;
  at->second.used = ++clock_;
  return at->second.transport;
}

void TransportStore::Entries::keep(const std::string& key, std::shared_ptr<const StoredTransport> transport) {
  ++store_.use_.made;
  const std::uint64_t bytes = transport->bytes();
  if (bytes > store_.most_bytes()) return;
  while (bytes_ + bytes > store_.most_bytes()) {
    const auto oldest =
        std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
  }
  bytes_ += bytes;
  entries_[key] = {std::move(transport), bytes, ++clock_};
}

bool TransportStore::Entries::has_room(std::size_t elements, const RadiosityDensity& density) const {
  constexpr double bytes_of_meeting = 16.0;  // a line that meets an element: links, and cells seen from both ends, while they wait
  return bytes_of_meeting * static_cast<double>(elements) * density.lines_per_element * density.directions <
         static_cast<double>(store_.most_bytes());
}

}  // namespace sunfleck
