#include "instantiation/stored_operators.hpp"

#include <algorithm>

#include <sunfleck/core/cache_folder.hpp>

#include "instantiation/operator_archive.hpp"

namespace sunfleck {

namespace {

/// Raised whenever operators change their numbers.
const std::string format_line = "sunfleck-operator 1\n";

OriginalLight copy_of(const OriginalLight& from) {
  OriginalLight to;
  to.elements = from.elements;
  to.interior = from.interior;
  to.facet_material = from.facet_material;
  to.facet_of_part = from.facet_of_part;
  to.coarse = std::make_unique<LineOperator>(*from.coarse);
  return to;
}

}  // namespace

void put_density(ContentKey& key, const OperatorDensity& density) {
  key.put(density.directions), key.put(density.lines_per_organ), key.put(density.field_pixels), key.put(density.points);
}

OperatorStore::OperatorStore(std::uint64_t most_bytes, std::string folder)
    : most_bytes_(most_bytes), entries_(std::make_unique<Entries>(*this, std::move(folder))) {}
OperatorStore::~OperatorStore() = default;

std::uint64_t OperatorStore::bytes() const {
  return entries_->bytes();
}

OperatorStore::Entries::Entries(OperatorStore& store, std::string folder)
    : store_(store), files_(std::move(folder), ".operator", store.most_bytes(), "operators are traced", silent()) {}

OriginalLight OperatorStore::Entries::original(const std::string& key, const std::function<OriginalLight()>& make) {
  auto entry = look_up(key, true);
  if (!entry.original) {
    const Stopwatch watch;
    entry.original = std::make_shared<const OriginalLight>(make());
    entry.seconds = watch.seconds();
    keep(key, entry);
  }
  auto out = copy_of(*entry.original);
  out.key = key;
  return out;
}

std::shared_ptr<const LineOperator> OperatorStore::Entries::fine(const std::string& key,
                                                                 const std::function<std::unique_ptr<LineOperator>()>& make) {
  auto entry = look_up(key, false);
  if (!entry.fine) {
    const Stopwatch watch;
    entry.fine = make();
    entry.seconds = watch.seconds();
    keep(key, entry);
  }
  return entry.fine;
}

OperatorStore::Entries::Entry OperatorStore::Entries::look_up(const std::string& key, bool is_original) {
  if (const auto at = entries_.find(key); at != entries_.end()) {
    ++store_.use_.found;
    store_.use_.saved_seconds += at->second.seconds;
    at->second.used = ++clock_;
    return at->second;
  }
  Entry entry;
  bool there = false;
  const auto bytes = files_.find(key, there);
  const auto payload = bytes ? payload_of(*bytes, format_line, key) : std::nullopt;
  if (payload && payload->size() >= sizeof entry.seconds) {
    std::copy_n(payload->data(), sizeof entry.seconds, reinterpret_cast<char*>(&entry.seconds));
    const auto rest = payload->substr(sizeof entry.seconds);
    if (is_original)
      entry.original = original_of_bytes(rest);
    else
      entry.fine = operator_of_bytes(rest);
  }
  if (!entry.original && !entry.fine) {
    ++store_.use_.made;
    return {};
  }
  ++store_.use_.read;
  store_.use_.saved_seconds += entry.seconds;
  hold(key, entry);
  return entry;
}

void OperatorStore::Entries::keep(const std::string& key, Entry entry) {
  hold(key, entry);
  if (files_.off()) return;
  const std::string head(reinterpret_cast<const char*>(&entry.seconds), sizeof entry.seconds);
  files_.store(key,
               sealed(format_line, key, head + (entry.original ? bytes_of_original(*entry.original) : bytes_of_operator(*entry.fine))));
}

void OperatorStore::Entries::hold(const std::string& key, Entry entry) {
  entry.bytes = entry.original ? entry.original->bytes() : entry.fine->bytes();
  entry.used = ++clock_;
  if (entry.bytes > store_.most_bytes()) return;
  while (bytes_ + entry.bytes > store_.most_bytes()) {
    const auto oldest =
        std::min_element(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    bytes_ -= oldest->second.bytes;
    entries_.erase(oldest);
  }
  bytes_ += entry.bytes;
  entries_[key] = std::move(entry);
}

}  // namespace sunfleck
