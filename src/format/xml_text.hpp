// XML files as UTF-8, whatever their declaration says.
#pragma once

#include <string>
#include <vector>

namespace sunfleck {

/// An XML file as UTF-8 without a byte-order mark; the declaration, if there is one, still names what the file was written in. Files that
/// say nothing or UTF-8 and are not are taken for Windows-1252, as are those that say ISO-8859-1 or windows-1252 (programs that claim the
/// first write the second); that the declaration is wrong is worth a note. InputError for a character set that nobody knows.
std::string read_xml(const std::string& file, std::vector<std::string>& notes);

}  // namespace sunfleck
