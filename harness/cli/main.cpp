#include "harness/cli/program.hpp"

int main(int argc, char** argv) { return qsmpc::harness::run_program(argc, argv); }
