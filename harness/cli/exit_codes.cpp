#include "harness/cli/exit_codes.hpp"

#include <iostream>
#include <new>
#include <string>

#include "harness/errors.hpp"
#include "harness/text/printable.hpp"
#include "harness/threads/interruption.hpp"

namespace qsmpc::harness {
namespace {

// Limits the line, however long an error's message is.
constexpr std::size_t kLineLimit = 2000;

int told(const std::string& text, ExitCode code) {
  std::cerr << "qsmpc: " << printable(text, kLineLimit) << '\n';
  return code;
}

}  // namespace

int report_exception(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const InputError& error) {
    return told(error.what(), kBadInput);
  } catch (const IoError& error) {
    return told(error.what(), kIoTrouble);
  } catch (const Interrupted& error) {
    return told(error.what(), kInterruptedExit);
  } catch (const std::bad_alloc&) {
    return told("out of memory; use fewer points, a shorter horizon or a smaller video",
                kIoTrouble);
  } catch (const std::exception& error) {
    return told("internal error: " + std::string(error.what()), kInternalError);
  } catch (...) {
    return told("unknown internal error", kInternalError);
  }
}

}  // namespace qsmpc::harness
