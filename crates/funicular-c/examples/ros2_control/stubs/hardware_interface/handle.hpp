// STUB, not ros2_control: the declarations that cable_controller.cpp uses, without behaviour.
#pragma once

#include <string>

namespace hardware_interface {

class CommandInterface {
 public:
  CommandInterface(const std::string &, const std::string &, double *) {}
};

class LoanedCommandInterface {
 public:
  [[nodiscard]] bool set_value(double) { return true; }
};

}  // namespace hardware_interface
