// The command-line program: parses arguments, runs the command, prints, and returns an exit code.
#pragma once

namespace qsmpc::harness {

/// Runs the program with `argv` as passed to `main`; returns the process's exit code and never
/// throws.
[[nodiscard]] int run_program(int argc, char** argv);

}  // namespace qsmpc::harness
