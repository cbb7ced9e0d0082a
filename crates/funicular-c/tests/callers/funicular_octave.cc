// Octave's caller of funicular_flat.h: [status, length, rate, tension] = funicular_octave(robot_file, input).
// Octave has no loadlibrary; mkoctfile makes this a function. The session stays open between calls.
#include <octave/oct.h>

#include "funicular_flat.h"

namespace {
struct Session {
  void *handle = nullptr;
  std::string path;
  ~Session() { fn_flat_close(handle); }
};
Session session;
}  // namespace

DEFUN_DLD(funicular_octave, arguments, , "[status, length, rate, tension] = funicular_octave(robot_file, input)") {
  if (arguments.length() != 2 || arguments(1).numel() != 25) error("a robot file and 25 numbers");
  const std::string path = arguments(0).string_value();
  if (session.handle == nullptr || session.path != path) {
    fn_flat_close(session.handle);
    session.handle = nullptr;
    char message[4000];
    if (fn_flat_open(path.c_str(), &session.handle, message, sizeof message) < 0) error("%s", message);
    session.path = path;
  }
  const NDArray input = arguments(1).array_value();
  const octave_idx_type cables = fn_flat_cables(session.handle);
  NDArray length(dim_vector(1, cables)), rate(dim_vector(1, cables)), tension(dim_vector(1, cables));
  const int32_t status = fn_flat_inverse(session.handle, input.data(), nullptr, length.fortran_vec(),
                                         rate.fortran_vec(), nullptr, nullptr, tension.fortran_vec());
  octave_value_list results;
  results(0) = status;
  results(1) = length;
  results(2) = rate;
  results(3) = tension;
  return results;
}
