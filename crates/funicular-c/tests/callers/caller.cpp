// A controller in C++17 by the thin layer. Argument: a robot file.
#include "funicular.hpp"

#include <cmath>
#include <cstdio>

int main(int count, char **arguments) {
  if (count != 2) return 1;
  try {
    const auto model = funicular::Model::from_file(arguments[1]);
    funicular::Loop loop(model);
    if (loop.warm_up() != FN_CERTIFIED) return 2;
    funicular::Lengths to;
    for (int tick = 0; tick < 100; tick++) {
      fn_pose_input input{};
      input.struct_size = sizeof input;
      input.position_m[0] = 1e-3 * tick;
      input.position_m[2] = 1.5;
      input.quaternion_wxyz[0] = 1.0;
      input.velocity_m_s[0] = 1.0;
      if (loop.inverse(input, to) != FN_CERTIFIED) return 3;
      if (!(std::fabs(to.length_rate_m_s[0]) < 1.0) || to.tension_drum_n[model.cables() - 1] <= 0.0) return 4;
    }
    std::printf("C++: %.6f m\n", to.length_m[0]);
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
  }
  // A file that is refused throws with its message.
  try {
    funicular::Model::from_toml("name = 3");
  } catch (const std::runtime_error &error) {
    return std::string(error.what()).size() > 20 ? 0 : 6;
  }
  return 7;
}
