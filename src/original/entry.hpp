// Cache entries as bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <sunfleck/original/tables.hpp>

namespace sunfleck {

/// Three lines of text (format, key, SHA-256 of the rest), then numbers as this machine holds them.
std::string to_entry(const OriginalTables& tables, const std::string& key);
/// Nothing if anything is not as to_entry() writes it for this key: cut short, changed, another format.
std::optional<OriginalTables> from_entry(std::string_view bytes, const std::string& key);

}  // namespace sunfleck
