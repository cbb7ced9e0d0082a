// STUB, not rclcpp: the declarations that cable_controller.cpp uses, without behaviour.
#pragma once

#include <string>
#include <vector>

namespace rclcpp {

class Time {};
class Duration {};

class Parameter {
 public:
  std::string as_string() const { return {}; }
  std::vector<std::string> as_string_array() const { return {}; }
};

class Logger {};

class Node {
 public:
  Parameter get_parameter(const std::string &) const { return {}; }
  template <class Value>
  Value declare_parameter(const std::string &, const Value &value) {
    return value;
  }
  Logger get_logger() const { return {}; }
};

}  // namespace rclcpp

#define RCLCPP_ERROR(logger, ...) ((void)(logger))
