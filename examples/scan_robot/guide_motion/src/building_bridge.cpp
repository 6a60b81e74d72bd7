// Tells the building where people stand, so that it turns on the light.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <string>

#include <geometry_msgs/msg/pose_array.hpp>
#include <rclcpp/rclcpp.hpp>

class BuildingBridge : public rclcpp::Node {
 public:
  BuildingBridge() : Node("building_bridge") {
    socket_ = socket(AF_INET, SOCK_DGRAM, 0);
    building_.sin_family = AF_INET;
    building_.sin_port = htons(4000);
    inet_pton(AF_INET, declare_parameter<std::string>("building", "192.0.2.7").c_str(), &building_.sin_addr);
    people_ = create_subscription<geometry_msgs::msg::PoseArray>(
        "people", 10, [this](const geometry_msgs::msg::PoseArray& people) { send(people); });
  }
  ~BuildingBridge() override { close(socket_); }

 private:
  void send(const geometry_msgs::msg::PoseArray& people) {
    for (const auto& person : people.poses) {
      const auto text = std::to_string(person.position.x) + " " + std::to_string(person.position.y) + "\n";
      sendto(socket_, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&building_), sizeof(building_));
    }
  }

  int socket_;
  sockaddr_in building_{};
  rclcpp::Subscription<geometry_msgs::msg::PoseArray>::SharedPtr people_;
};

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<BuildingBridge>());
  rclcpp::shutdown();
}
