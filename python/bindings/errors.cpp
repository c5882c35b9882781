// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/errors.hpp"

#include <exception>

namespace py = pybind11;

namespace palpate::python {

namespace {

/// The classes, which live as long as the process: a translator may run until its end.
struct ErrorClasses {
  py::object input;
  py::object run;
  py::object solve;
};

ErrorClasses& Classes() {
  static auto* const classes = new ErrorClasses;
  return *classes;
}

py::object NewClass(py::module_& module, const char* name, py::handle base, const char* text) {
  const std::string full_name = std::string("palpate.") + name;
  auto made = py::reinterpret_steal<py::object>(
      PyErr_NewExceptionWithDoc(full_name.c_str(), text, base.ptr(), nullptr));
  if (!made) throw py::error_already_set();
  module.attr(name) = made;
  return made;
}

void Raise(const SolveFailure& failure) {
  const py::object error = Classes().solve(failure.what());
  error.attr("status") = std::string(ToString(failure.status()));
  error.attr("load_fraction") = failure.load_fraction();
  PyErr_SetObject(Classes().solve.ptr(), error.ptr());
}

void Translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const SolveFailure& failure) {
    Raise(failure);
  } catch (const InputError& error) {
    PyErr_SetString(Classes().input.ptr(), error.what());
  } catch (const RunError& error) {
    PyErr_SetString(Classes().run.ptr(), error.what());
  }
}

}  // namespace

void BindErrors(py::module_& module) {
  ErrorClasses& classes = Classes();
  classes.input = NewClass(module, "InputError", PyExc_ValueError,
                           "Bad settings, files or data; begins with file:line:column.");
  classes.run = NewClass(module, "RunError", PyExc_RuntimeError,
                         "Sound input, but the work failed while running.");
  classes.solve =
      NewClass(module, "SolveError", classes.run, "No result that may be used: `status` says why.");
  classes.solve.attr("status") = std::string(ToString(StatusCode::kNotRun));
  classes.solve.attr("load_fraction") = 0.0;
  py::register_exception_translator(Translate);
}

}  // namespace palpate::python
