// Where people stand, by the laser at the height of their legs.
#include <cmath>
#include <memory>
#include <string>

#include <geometry_msgs/msg/pose_array.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/laser_scan.hpp>

class PersonTracker : public rclcpp::Node {
 public:
  PersonTracker() : Node("person_tracker") {
    const std::string topic = declare_parameter<std::string>("people_topic", "people");
    people_ = create_publisher<geometry_msgs::msg::PoseArray>(topic, 10);
    scan_ = create_subscription<sensor_msgs::msg::LaserScan>(
        "scan", rclcpp::SensorDataQoS(), [this](const sensor_msgs::msg::LaserScan& scan) { track(scan); });
  }

 private:
  void track(const sensor_msgs::msg::LaserScan& scan) {
    geometry_msgs::msg::PoseArray people;
    people.header = scan.header;
    for (size_t at = 1; at < scan.ranges.size(); at++) {
      if (scan.ranges[at - 1] - scan.ranges[at] > 0.5) {
        const double angle = scan.angle_min + at * scan.angle_increment;
        geometry_msgs::msg::Pose person;
        person.position.x = scan.ranges[at] * std::cos(angle);
        person.position.y = scan.ranges[at] * std::sin(angle);
        people.poses.push_back(person);
      }
    }
    people_->publish(people);
  }

  rclcpp::Publisher<geometry_msgs::msg::PoseArray>::SharedPtr people_;
  rclcpp::Subscription<sensor_msgs::msg::LaserScan>::SharedPtr scan_;
};

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<PersonTracker>());
  rclcpp::shutdown();
}
