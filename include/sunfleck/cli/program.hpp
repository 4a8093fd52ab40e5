// The command line program: parses, calls the library, maps errors to exit codes.
#pragma once

namespace sunfleck {

/// Exit codes: 0 done, 1 output could not be written, not enough memory, or another failure, 2 bad usage or bad input, 3 did not converge
/// or is not as accurate as asked (the result is written, its status says which), 4 stopped.
int run_program(int argc, char** argv);

}  // namespace sunfleck
