// A node with annotations: it makes faces unrecognisable.
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/image.hpp>

// privacy: sanitizer Video anonymise
class Blur : public rclcpp::Node
{
public:
  Blur()
  : Node("blur")
  {
    images_ = create_publisher<sensor_msgs::msg::Image>("image_blurred", 10);
  }

private:
  rclcpp::Publisher<sensor_msgs::msg::Image>::SharedPtr images_;
};
