#include <sunfleck/cli/program.hpp>
#include <sunfleck/core/release_memory.hpp>

int main(int argc, char** argv) {
  sunfleck::map_large_arrays();
  return sunfleck::run_program(argc, argv);
}
