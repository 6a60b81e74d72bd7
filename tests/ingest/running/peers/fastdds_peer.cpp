// A DDS participant that is not ours (Fast DDS), which says of itself what a ROS 2 middleware says: endpoints on mangled
// topics, user data of participants and endpoints, and samples of ros_discovery_info that say which node has which endpoint.
//
// It reads commands, one on each line; in words, %XX stands for a byte, and - for nothing:
//   participant DOMAIN ENCLAVE GID_BYTES   node NAMESPACE NAME      writer TOPIC TYPE HASH   reader TOPIC TYPE
//   declare TOPIC TYPE TEXT TEXT TEXT TEXT
//   loose-writer TOPIC TYPE HASH           announce                 leave                    seen    quit
// A loose writer is one that no node has. After each command it prints a line that begins with "done". All traffic stays
// on 127.0.0.1: no multicast.
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <set>

#include "fastdds_parts.hpp"

// Little-endian CDR, as far as ParticipantEntitiesInfo needs it.
struct Cdr {
  Bytes bytes{0, 1, 0, 0};
  void number(uint32_t value) {
    while ((bytes.size() - 4) % 4) bytes.push_back(0);
    for (int i = 0; i < 4; i++) bytes.push_back(value >> (8 * i));
  }
  void text(const std::string& value) {
    number(value.size() + 1);
    bytes.insert(bytes.end(), value.begin(), value.end());
    bytes.push_back(0);
  }
  void gid(const GUID_t& guid, size_t length) {
    Bytes padded(length, 0);
    std::memcpy(padded.data(), guid.guidPrefix.value, 12);
    std::memcpy(padded.data() + 12, guid.entityId.value, 4);
    bytes.insert(bytes.end(), padded.begin(), padded.end());
  }
};

struct Node {
  std::string space, name;
  std::vector<GUID_t> readers, writers;
};

// What others say of themselves: what our observer must not look like.
struct Listener : DomainParticipantListener {
  std::set<std::string> participants;
  int node_writers = 0;
  void on_participant_discovery(DomainParticipant*, ParticipantDiscoveryInfo&& info) override {
    std::ostringstream guid;
    guid << info.info.m_guid.guidPrefix;
    if (info.status == ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT) participants.insert(guid.str());
    if (info.status == ParticipantDiscoveryInfo::REMOVED_PARTICIPANT) participants.erase(guid.str());
  }
  void on_publisher_discovery(DomainParticipant* own, WriterDiscoveryInfo&& info) override {
    if (info.info.guid().guidPrefix == own->guid().guidPrefix) return;
    if (info.info.topicName() == "ros_discovery_info") node_writers++;
  }
};

static const char* const NODES_TYPE = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

class Peer {
 public:
  Peer(int domain, const std::string& enclave, size_t gid_bytes) : gid_bytes_(gid_bytes) {
    DomainParticipantQos qos = on_loopback();
    if (!enclave.empty()) qos.user_data().setValue(bytes("enclave=" + enclave + ";"));
    participant_ = DomainParticipantFactory::get_instance()->create_participant(domain, qos, &listener_);
    publisher_ = participant_->create_publisher(PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  }

  ~Peer() {
    participant_->delete_contained_entities();
    DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  void node(const std::string& space, const std::string& name) { nodes_.push_back({space, name, {}, {}}); }

  void writer(const std::string& name, const std::string& type, const std::string& hash, bool of_node) {
    DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
    if (!hash.empty()) qos.user_data().setValue(bytes("typehash=" + hash + ";"));
    auto* writer = publisher_->create_datawriter(topic(name, type), qos);
    if (of_node) nodes_.back().writers.push_back(writer->guid());
  }

  // A writer of the last node, and one sample of texts, which late readers get too.
  void declare(const std::string& name, const std::string& type, const std::vector<std::string>& texts) {
    DataWriterQos kept = DATAWRITER_QOS_DEFAULT;
    kept.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
    kept.reliability().kind = RELIABLE_RELIABILITY_QOS;
    auto* writer = publisher_->create_datawriter(topic(name, type), kept);
    nodes_.back().writers.push_back(writer->guid());
    Cdr sample;
    for (const auto& text : texts) sample.text(text);
    writer->write(&sample.bytes);
  }

  void reader(const std::string& name, const std::string& type) {
    nodes_.back().readers.push_back(subscriber_->create_datareader(topic(name, type), DATAREADER_QOS_DEFAULT)->guid());
  }

  void announce() {
    Cdr sample;
    sample.gid(participant_->guid(), gid_bytes_);
    sample.number(nodes_.size());
    for (const auto& node : nodes_) {
      sample.text(node.space);
      sample.text(node.name);
      for (const auto* guids : {&node.readers, &node.writers}) {
        sample.number(guids->size());
        for (const auto& guid : *guids) sample.gid(guid, gid_bytes_);
      }
    }
    if (!nodes_writer_) {
      DataWriterQos kept = DATAWRITER_QOS_DEFAULT;
      kept.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
      kept.reliability().kind = RELIABLE_RELIABILITY_QOS;
      kept.history().kind = KEEP_LAST_HISTORY_QOS;
      kept.history().depth = 1;
      nodes_writer_ = publisher_->create_datawriter(topic("ros_discovery_info", NODES_TYPE), kept);
    }
    nodes_writer_->write(&sample.bytes);
  }

  std::string seen() const {
    return std::to_string(listener_.participants.size()) + " " + std::to_string(listener_.node_writers);
  }

 private:
  static Bytes bytes(const std::string& text) { return Bytes(text.begin(), text.end()); }

  Topic* topic(const std::string& name, const std::string& type) {
    if (!participant_->find_type(type)) TypeSupport(new Serialised(type)).register_type(participant_);
    auto& known = topics_[name];
    if (!known) known = participant_->create_topic(name, type, TOPIC_QOS_DEFAULT);
    return known;
  }

  size_t gid_bytes_;
  Listener listener_;
  DomainParticipant* participant_;
  Publisher* publisher_;
  Subscriber* subscriber_;
  DataWriter* nodes_writer_ = nullptr;
  std::map<std::string, Topic*> topics_;
  std::vector<Node> nodes_;
};

int main() {
  std::unique_ptr<Peer> peer;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    const std::string command = word(words);
    std::string answer;
    if (command == "quit") break;
    if (command == "participant") {
      const int domain = std::stoi(word(words));
      const std::string enclave = word(words);
      peer = std::make_unique<Peer>(domain, enclave, std::stoi(word(words)));
    } else if (command == "leave") {
      peer.reset();
    } else if (command == "node") {
      const std::string space = word(words);
      peer->node(space, word(words));
    } else if (command == "writer" || command == "loose-writer") {
      const std::string topic = word(words), type = word(words);
      peer->writer(topic, type, word(words), command == "writer");
    } else if (command == "declare") {
      const std::string topic = word(words), type = word(words);
      std::vector<std::string> texts(4);
      for (auto& text : texts) text = word(words);
      peer->declare(topic, type, texts);
    } else if (command == "reader") {
      const std::string topic = word(words);
      peer->reader(topic, word(words));
    } else if (command == "announce") {
      peer->announce();
    } else if (command == "seen") {
      answer = " " + peer->seen();
    } else {
      std::cerr << "unknown command: " << command << std::endl;
      return 2;
    }
    std::cout << "done" << answer << std::endl;
  }
}
