// SPDX-License-Identifier: MIT
#include "common/io/robot/pickle_writer.h"

#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "common/support/error.h"
#include "common/support/text.h"

namespace mmm_converter {
namespace {

template <typename Number>
void AppendLittleEndian(Number number, std::string* out) {
  char bytes[sizeof number];
  std::memcpy(bytes, &number, sizeof number);
  out->append(bytes, sizeof number);
}

/// Opcodes as Python's module pickletools describes them.
class Pickler {
 public:
  std::string Write(const PickleValue& value) {
    out_ = "\x80\x03";  // PROTO
    std::visit([this](const auto& one) { Put(one); }, value.value);
    return std::move(out_) + ".";  // STOP
  }

 private:
  void Put(double number) {
    out_ += 'G';  // BINFLOAT, big-endian
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (std::size_t i = sizeof number; i-- > 0;) out_ += bytes[i];
  }
  void Put(std::int64_t number) {
    out_ += "\x8a\x08";  // LONG1
    AppendLittleEndian(number, &out_);
  }
  void Put(const std::string& raw) {
    const std::string text = ToUtf8(raw);
    out_ += 'X';  // BINUNICODE
    AppendLittleEndian(static_cast<std::uint32_t>(text.size()), &out_);
    out_ += text;
  }
  void PutBytes(const char* bytes, std::size_t size) {
    if (size > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(
          "an array has 4 GB or more, for which a pickle of this kind has no room; write fewer "
          "frames");
    }
    out_ += 'B';  // BINBYTES
    AppendLittleEndian(static_cast<std::uint32_t>(size), &out_);
    out_.append(bytes, size);
  }
  void PutGlobal(const char* module, const char* name) {
    out_ += fmt::format("c{}\n{}\n", module, name);  // GLOBAL
  }

  void Put(const std::vector<std::string>& texts) {
    out_ += "](";  // EMPTY_LIST MARK
    for (const std::string& text : texts) Put(text);
    out_ += 'e';  // APPENDS
  }
  void Put(const PickleValue::Dict& dict) {
    out_ += "}(";  // EMPTY_DICT MARK
    for (const auto& [key, value] : dict) {
      Put(key);
      std::visit([this](const auto& one) { Put(one); }, value.value);
    }
    out_ += 'u';  // SETITEMS
  }
  /// _reconstruct(ndarray, (0,), b"b") and its state: (1, shape, dtype, False, bytes).
  void Put(const NpyArray& array) {
    PutGlobal("numpy.core.multiarray", "_reconstruct");
    PutGlobal("numpy", "ndarray");
    out_ += "K";  // BININT1
    out_ += '\0';
    out_ += "\x85";  // TUPLE1
    out_ +=
        "C\x01"  // SHORT_BINBYTES
        "b";
    out_ += "\x87R(K\x01(";  // TUPLE3 REDUCE MARK 1 MARK
    for (const std::int64_t size : array.shape) Put(size);
    out_ += 't';  // TUPLE
    PutDoubleType();
    out_ += "\x89";  // NEWFALSE
    PutBytes(reinterpret_cast<const char*>(array.numbers.data()),
             array.numbers.size() * sizeof(double));
    out_ += "tb";  // TUPLE BUILD
  }
  /// dtype("f8", False, True) and its state: (3, "<", None, None, None, -1, -1, 0).
  void PutDoubleType() {
    PutGlobal("numpy", "dtype");
    Put(std::string("f8"));
    out_ += "\x89\x88\x87R(K\x03";  // NEWFALSE NEWTRUE TUPLE3 REDUCE MARK 3
    Put(std::string("<"));
    out_ += "NNN";
    Put(std::int64_t{-1});
    Put(std::int64_t{-1});
    out_ += "K";
    out_ += '\0';
    out_ += "tb";
  }

  std::string out_;
};

}  // namespace

std::string FormatPickle(const PickleValue& value) { return Pickler().Write(value); }

}  // namespace mmm_converter
