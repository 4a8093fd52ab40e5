#include <sunfleck/cli/program.hpp>

int main(int argc, char** argv) {
  return sunfleck::run_program(argc, argv);
}
