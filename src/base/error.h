// How failures travel: bad data, I/O and network errors are values; broken invariants abort.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace eye {

enum class ErrorKind {
  usage,        // the caller's options are wrong: exit code 2
  notFound,     // a file, device or tile that is not there
  badData,      // a file or packet whose content cannot be trusted
  io,           // reading or writing failed
  noSpace,      // the disk is full
  unsupported,  // understood, but this build, device or version cannot do it
  device,       // the Vulkan device failed or complained
};

// `message` is one line for a person: what was wrong, where, and what to do.
struct Error {
  ErrorKind kind = ErrorKind::badData;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorKind kind, std::string message) {
  return tl::unexpected<Error>(Error{kind, std::move(message)});
}

// The exit status that CONTRACT promises for an error: 2 for bad usage, else 1.
inline int exitStatus(const Error& error) {
  return error.kind == ErrorKind::usage ? 2 : 1;
}

[[noreturn]] void checkFailed(const char* expression, const char* file, int line);

}  // namespace eye

// A broken invariant or a programmer's error: prints where and aborts, in every build type.
#define EYE_CHECK(expression) ((expression) ? void(0) : ::eye::checkFailed(#expression, __FILE__, __LINE__))
