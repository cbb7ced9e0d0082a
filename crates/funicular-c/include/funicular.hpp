// Thin layer over funicular.h for C++17: a model and its loops end by themselves. Set-up throws; the loop does not.
#ifndef FUNICULAR_HPP
#define FUNICULAR_HPP

#include "funicular.h"

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace funicular {
inline std::string text(std::int32_t status) {
  std::array<char, 200> to{};
  fn_status_text(status, to.data(), to.size());
  return to.data();
}

// Robot, read only. It lives as long as a loop needs it.
class Model {
 public:
  static Model from_file(const std::string &path) {
    return make([&](fn_model **to, char *message, std::size_t bytes) {
      return fn_model_from_file(path.c_str(), to, message, bytes);
    });
  }
  static Model from_toml(const std::string &toml) {
    return make([&](fn_model **to, char *message, std::size_t bytes) {
      return fn_model_from_toml(toml.data(), toml.size(), to, message, bytes);
    });
  }
  std::uint32_t cables() const {
    std::uint32_t count = 0;
    fn_model_cables(model_.get(), &count);
    return count;
  }
  const std::shared_ptr<fn_model> &handle() const { return model_; }

 private:
  template <class From>
  static Model make(From from) {
    if (fn_abi_version() != FN_ABI_VERSION) throw std::runtime_error("funicular: header and library differ");
    fn_model *model = nullptr;
    std::vector<char> message(4096);
    const auto status = from(&model, message.data(), message.size());
    if (status < 0) throw std::runtime_error(text(status) + "\n" + message.data());
    return Model(std::shared_ptr<fn_model>(model, fn_model_free));
  }
  explicit Model(std::shared_ptr<fn_model> model) : model_(std::move(model)) {}
  std::shared_ptr<fn_model> model_;
};

// Lengths and tensions of all cables, with their summary.
struct Lengths {
  using Row = std::array<double, FN_MAX_CABLES>;
  fn_inverse_result summary{};
  Row length_m{}, length_rate_m_s{}, length_acceleration_m_s2{}, tension_platform_n{}, tension_drum_n{};
};

// State of one loop; its functions reserve no memory and do not throw.
class Loop {
 public:
  explicit Loop(const Model &model) : model_(model.handle()) {
    std::size_t bytes = 0, alignment = 0;
    fn_loop_bytes(model_.get(), &bytes, &alignment);
    memory_.resize(bytes + alignment);
    void *place = memory_.data();
    std::size_t room = memory_.size();
    const auto status = fn_loop_init(model_.get(), std::align(alignment, bytes, place, room), bytes, &loop_);
    if (status < 0) throw std::runtime_error(text(status));
  }
  Loop(const Loop &) = delete;
  Loop &operator=(const Loop &) = delete;
  ~Loop() { fn_loop_end(loop_); }

  std::int32_t warm_up() noexcept { return fn_warm_up(loop_); }
  std::int32_t inverse(const fn_pose_input &input, Lengths &to) noexcept {
    to.summary = {};
    to.summary.struct_size = sizeof(to.summary);
    to.summary.cables = FN_MAX_CABLES;
    to.summary.length_m = to.length_m.data();
    to.summary.length_rate_m_s = to.length_rate_m_s.data();
    to.summary.length_acceleration_m_s2 = to.length_acceleration_m_s2.data();
    to.summary.tension_platform_n = to.tension_platform_n.data();
    to.summary.tension_drum_n = to.tension_drum_n.data();
    return fn_inverse(loop_, &input, &to.summary);
  }
  fn_loop *handle() noexcept { return loop_; }

 private:
  std::shared_ptr<fn_model> model_;
  std::vector<unsigned char> memory_;
  fn_loop *loop_ = nullptr;
};

}  // namespace funicular
#endif
