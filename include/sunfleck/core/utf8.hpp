// Text as UTF-8, which is what every output of ours holds.
#pragma once

#include <string>
#include <string_view>

namespace sunfleck {

/// Whether the bytes are UTF-8 (RFC 3629): no over-long forms, surrogates, or code points above U+10FFFF.
bool is_utf8(std::string_view bytes);

/// Bytes of Windows-1252, which is ISO 8859-1 with letters and signs at 0x80 to 0x9F, as UTF-8 (WHATWG Encoding, windows-1252).
std::string from_windows_1252(std::string_view bytes);

/// The bytes where they are UTF-8; else as Windows-1252.
std::string as_utf8(std::string_view bytes);

/// Whether a text has a control character: U+0000 to U+001F, U+007F to U+009F (a name with one breaks the lines, the markup or the terminal
/// that it is written to).
bool has_control_character(std::string_view utf8);

/// A name that every output can hold: as UTF-8, each control character a blank.
std::string clean_name(std::string_view bytes);

}  // namespace sunfleck
