// SPDX-License-Identifier: MIT
#include "MMMConverterS2KF/python/module.h"

#include <exception>

#include "MMMConverterS2KF/python/requests.h"
#include "MMMConverterS2KF/report/version.h"
#include "common/support/error.h"

namespace py = pybind11;

PYBIND11_MODULE(_mmmconverter, module) {
  using namespace mmm_converter;  // NOLINT(google-build-using-namespace): a module's body
  module.doc() = "The compiled part of mmmconverter.";
  static py::exception<Error> error(module, "Error");
  py::register_exception_translator([](std::exception_ptr raised) {
    try {
      if (raised) std::rethrow_exception(raised);
    } catch (const Error& failure) {
      error(WithAdvice(failure).c_str());
    }
  });
  SetWording(WordingOf(Medium::kPython));
  module.def("version_text", &VersionText);
  python::BindRecordings(&module);
  python::BindModels(&module);
  python::BindConversions(&module);
  python::BindStudies(&module);
  python::BindLive(&module);
  python::BindOptions(&module);
}
