// Standard error and standard output when they cannot be written: messages may be lost, data may not be lost unnoticed.
#pragma once

#include <string_view>

namespace sunfleck {

/// Opens what of descriptors 0 to 2 is closed, so that no file of ours becomes one of them and is written into, in a way that lets writing
/// fail. A file that grows too large for the user's limit, or a pipe that nobody reads any more, is then an error of its
/// writer, no signal.
void prepare_streams();

/// Writes to standard error at once. What cannot be written is lost: a message is no reason to give up the work.
void tell(std::string_view text);

/// Flushes standard output; false if anything of it was lost.
bool output_arrived();

}  // namespace sunfleck
