// SPDX-License-Identifier: MIT
#include "analysis/trace/demangle.h"

#include <cxxabi.h>

#include <array>
#include <cstdlib>
#include <memory>

namespace stipple {
namespace {

/// What compilers append to the copies that they make of a function.
constexpr std::array<std::string_view, 8> kCloneSuffixes = {
    ".constprop.", ".isra.", ".part.", ".cold", ".lto_priv.", ".localalias", ".llvm.", ".clone."};

std::string_view WithoutClone(std::string_view name) {
  for (const std::string_view suffix : kCloneSuffixes)
    if (const std::size_t at = name.find(suffix); at != 0 && at != std::string_view::npos)
      name = name.substr(0, at);
  return name;
}

/// gfortran: __MODULE_MOD_PROCEDURE.
std::string FortranName(std::string_view name) {
  constexpr std::string_view kMod = "_MOD_";
  const std::size_t at = name.find(kMod);
  if (name.substr(0, 2) != "__" || at == std::string_view::npos || at <= 2) return {};
  return std::string(name.substr(2, at - 2)) + "::" + std::string(name.substr(at + kMod.size()));
}

}  // namespace

std::string Demangle(std::string_view linkage_name) {
  const std::string name(WithoutClone(linkage_name));
  if (name.starts_with("_Z")) {
    int status = 0;
    const std::unique_ptr<char, decltype(&std::free)> text(
        abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status), &std::free);
    if (status == 0 && text != nullptr) return text.get();
  }
  if (std::string fortran = FortranName(name); !fortran.empty()) return fortran;
  return name;
}

}  // namespace stipple
