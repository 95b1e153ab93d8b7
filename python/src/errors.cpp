// The library's errors as Python exceptions.
#include "harness/errors.hpp"

#include <exception>
#include <string>

#include "python/src/module.hpp"
#include <nanobind/stl/string.h>

#include "harness/threads/interruption.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;

// They live as long as the module, which is never unloaded.
PyObject* input_error = nullptr;
PyObject* io_error = nullptr;

PyObject* new_exception(nb::module_& module, const char* name, PyObject* base, const char* doc) {
  const std::string full = std::string("qsmpc.") + name;
  PyObject* const type = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, nullptr);
  if (type == nullptr) throw nb::python_error();
  module.attr(name) = nb::handle(type);
  return type;
}

void raise_input_error(const harness::InputError& error) {
  const harness::InputError::Where& where = error.where();
  const nb::object value = nb::handle(input_error)(error.what());
  value.attr("file") = where.file;
  value.attr("line") = where.line;
  value.attr("key") = where.key;
  value.attr("found") = where.found;
  value.attr("expected") = where.expected;
  PyErr_SetObject(input_error, value.ptr());
}

void translate(const std::exception_ptr& pointer, void* /*unused*/) {
  try {
    std::rethrow_exception(pointer);
  } catch (const harness::InputError& error) {
    raise_input_error(error);
  } catch (const harness::IoError& error) {
    PyErr_SetString(io_error, error.what());
  } catch (const harness::Interrupted&) {
    // If Python has received the signal, its own handler decides which exception it becomes.
    if (PyErr_CheckSignals() == 0) PyErr_SetNone(PyExc_KeyboardInterrupt);
  }
}

}  // namespace

void add_errors(nb::module_& module) {
  input_error = new_exception(
      module, "InputError", PyExc_ValueError,
      "A file or a value is invalid. The message is one line with file, line, key, what was found\n"
      "and what was expected, each of which is also an attribute (`file`, `line`, `key`, `found`,\n"
      "`expected`; empty or 0 if not known).");
  io_error = new_exception(module, "IoError", PyExc_OSError,
                           "A file or folder cannot be read or written.");
  nb::register_exception_translator(translate);
}

}  // namespace qsmpc::python
