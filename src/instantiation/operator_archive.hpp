// Originals with their operators as bytes, and back.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "instantiation/members.hpp"

namespace sunfleck {

/// Bytes of this build: numbers as the machine has them.
std::string bytes_of_original(const OriginalLight& original);
std::string bytes_of_operator(const LineOperator& op);
/// Null where the bytes are not whole.
std::unique_ptr<OriginalLight> original_of_bytes(std::string_view bytes);
std::unique_ptr<LineOperator> operator_of_bytes(std::string_view bytes);

}  // namespace sunfleck
