// Controller of ros2_control: pose and twist of the platform in, length and rate of every cable out. See README.md.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "controller_interface/chainable_controller_interface.hpp"
#include "funicular.hpp"
#include "pluginlib/class_list_macros.hpp"

namespace cable_controller {

using controller_interface::CallbackReturn;
using controller_interface::interface_configuration_type;
using controller_interface::InterfaceConfiguration;
using controller_interface::return_type;

// Names of the reference interfaces: position, quaternion, velocity and angular velocity of the platform.
const std::array<const char *, 13> kReferences = {"x",  "y",  "z",  "qw", "qx", "qy", "qz",
                                                  "vx", "vy", "vz", "wx", "wy", "wz"};

class CableController : public controller_interface::ChainableControllerInterface {
 public:
  CallbackReturn on_init() override {
    get_node()->declare_parameter<std::string>("robot_file", "");
    get_node()->declare_parameter<std::vector<std::string>>("winches", {});
    return CallbackReturn::SUCCESS;
  }

  // All memory is reserved here. A robot that a loop cannot compute ends the configuration with its message.
  CallbackReturn on_configure(const rclcpp_lifecycle::State &) override {
    winches_ = get_node()->get_parameter("winches").as_string_array();
    try {
      const auto model = funicular::Model::from_file(get_node()->get_parameter("robot_file").as_string());
      if (winches_.size() != model.cables()) {
        RCLCPP_ERROR(get_node()->get_logger(), "the robot has %u cables", model.cables());
        return CallbackReturn::FAILURE;
      }
      loop_ = std::make_unique<funicular::Loop>(model);
    } catch (const std::exception &error) {
      RCLCPP_ERROR(get_node()->get_logger(), "%s", error.what());
      return CallbackReturn::FAILURE;
    }
    return CallbackReturn::SUCCESS;
  }

  // The first call in the loop is then as fast as the others.
  CallbackReturn on_activate(const rclcpp_lifecycle::State &) override {
    return loop_->warm_up() >= FN_CERTIFIED ? CallbackReturn::SUCCESS : CallbackReturn::FAILURE;
  }

  InterfaceConfiguration command_interface_configuration() const override {
    InterfaceConfiguration all{interface_configuration_type::INDIVIDUAL, {}};
    for (const auto &winch : winches_) {
      all.names.push_back(winch + "/position");
      all.names.push_back(winch + "/velocity");
    }
    return all;
  }

  InterfaceConfiguration state_interface_configuration() const override {
    return {interface_configuration_type::NONE, {}};
  }

 protected:
  std::vector<hardware_interface::CommandInterface> on_export_reference_interfaces() override {
    reference_interfaces_.assign(kReferences.size(), 0.0);
    std::vector<hardware_interface::CommandInterface> all;
    for (std::size_t k = 0; k < kReferences.size(); k++)
      all.emplace_back("platform", kReferences[k], &reference_interfaces_[k]);
    return all;
  }

  return_type update_reference_from_subscribers(const rclcpp::Time &, const rclcpp::Duration &) override {
    return return_type::OK;
  }

  // Reserves nothing. Only certified and accepted lengths go to the winches; else these keep their last command, and the
  // caller of the controller sees the error.
  return_type update_and_write_commands(const rclcpp::Time &, const rclcpp::Duration &) override {
    fn_pose_input input{};
    input.struct_size = sizeof input;
    const double *from = reference_interfaces_.data();
    std::copy(from, from + 3, input.position_m);
    std::copy(from + 3, from + 7, input.quaternion_wxyz);
    std::copy(from + 7, from + 10, input.velocity_m_s);
    std::copy(from + 10, from + 13, input.angular_velocity_rad_s);

    const auto status = loop_->inverse(input, lengths_);
    if (status != FN_CERTIFIED && status != FN_ACCEPTED) return return_type::ERROR;
    bool is_written = true;
    for (std::size_t i = 0; i < winches_.size(); i++) {
      is_written &= command_interfaces_[2 * i].set_value(lengths_.length_m[i]);
      is_written &= command_interfaces_[2 * i + 1].set_value(lengths_.length_rate_m_s[i]);
    }
    return is_written ? return_type::OK : return_type::ERROR;
  }

 private:
  std::vector<std::string> winches_;
  std::unique_ptr<funicular::Loop> loop_;
  funicular::Lengths lengths_;
};

}  // namespace cable_controller

PLUGINLIB_EXPORT_CLASS(cable_controller::CableController, controller_interface::ChainableControllerInterface)
