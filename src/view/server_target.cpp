#include "view/server_target.hpp"

#include <algorithm>
#include <charconv>

namespace sunfleck {

namespace {

std::string decoded(std::string_view text, bool query) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2)
      out += static_cast<char>(byte), i += 2;
    else
      out += query && text[i] == '+' ? ' ' : text[i];
  }
  return out;
}

}  // namespace

std::optional<std::string> RequestTarget::value(std::string_view name) const {
  const auto found = std::find_if(values.begin(), values.end(), [&](const auto& one) { return one.first == name; });
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::optional<RequestTarget> parse_target(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  target = target.substr(0, target.find('#'));
  const std::size_t question = std::min(target.find('?'), target.size());
  RequestTarget out;
  out.path = decoded(target.substr(0, question), false);
  for (std::size_t at = question + 1; at < target.size();) {
    const std::size_t end = std::min(target.find('&', at), target.size());
    const auto one = target.substr(at, end - at);
    const std::size_t equals = std::min(one.find('='), one.size());
    if (equals > 0)
      out.values.emplace_back(decoded(one.substr(0, equals), true), decoded(one.substr(std::min(equals + 1, one.size())), true));
    at = end + 1;
  }
  return out;
}

}  // namespace sunfleck
