// Participants that are not ours (Fast DDS), each with the security plugins; commands are those of secured_commands.hpp.
// The seats of a domain are 0 to 3: Fast DDS numbers all participants of a process, whatever their domain, and looks for
// others at the ports of the first four only.
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <set>

#include "fastdds_parts.hpp"
#include "secured_commands.hpp"

static DomainParticipantQos secured(int domain, int seat, const std::string& folder) {
  DomainParticipantQos qos = on_loopback();
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.begin()->port = 7410 + 250 * domain + 2 * seat;
  if (folder.empty()) return qos;
  const std::string sec = "dds.sec.", auth = sec + "auth.builtin.PKI-DH.", access = sec + "access.builtin.Access-Permissions.";
  const std::pair<std::string, std::string> plugins[] = {{sec + "auth.plugin", "builtin.PKI-DH"},
                                                         {sec + "access.plugin", "builtin.Access-Permissions"},
                                                         {sec + "crypto.plugin", "builtin.AES-GCM-GMAC"}};
  const std::pair<std::string, std::string> files[] = {
      {auth + "identity_ca", "identity_ca.cert.pem"}, {auth + "identity_certificate", "cert.pem"},
      {auth + "private_key", "key.pem"},              {access + "permissions_ca", "permissions_ca.cert.pem"},
      {access + "governance", "governance.p7s"},      {access + "permissions", "permissions.p7s"}};
  for (const auto& [name, value] : plugins) qos.properties().properties().emplace_back(name, value);
  for (const auto& [name, file] : files) qos.properties().properties().emplace_back(name, "file://" + folder + "/" + file);
  return qos;
}

class Secured {
 public:
  Secured(int domain, int seat, const std::string& folder)
      : participant_(
            DomainParticipantFactory::get_instance()->create_participant(domain, secured(domain, seat, folder))) {}

  bool there() const { return participant_ != nullptr; }

  bool writer(const std::string& name, const std::string& partition) {
    PublisherQos where = PUBLISHER_QOS_DEFAULT;
    if (!partition.empty()) where.partition().push_back(partition.c_str());
    DataWriterQos kept = DATAWRITER_QOS_DEFAULT;
    kept.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
    kept.reliability().kind = RELIABLE_RELIABILITY_QOS;
    auto* writer = participant_->create_publisher(where)->create_datawriter(topic(name), kept);
    Bytes sample{0, 1, 0, 0, 42};
    return writer && writer->write(&sample);
  }

  bool reader(const std::string& name, const std::string& partition) {
    SubscriberQos where = SUBSCRIBER_QOS_DEFAULT;
    if (!partition.empty()) where.partition().push_back(partition.c_str());
    DataReaderQos kept = DATAREADER_QOS_DEFAULT;
    kept.durability().kind = TRANSIENT_LOCAL_DURABILITY_QOS;
    kept.reliability().kind = RELIABLE_RELIABILITY_QOS;
    auto* reader = participant_->create_subscriber(where)->create_datareader(topic(name), kept);
    if (reader) readers_.emplace_back(name, reader);
    return reader != nullptr;
  }

  std::string received() const {
    std::string names;
    for (const auto& [name, reader] : readers_) {
      Bytes sample;
      SampleInfo info;
      if (reader->read_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK && info.valid_data) got_.insert(name);
    }
    for (const auto& name : got_) names += " " + name;
    return names;
  }

 private:
  Topic* topic(const std::string& name) {
    const std::string type = "std_msgs::msg::dds_::String_";
    if (!participant_->find_type(type)) TypeSupport(new Serialised(type)).register_type(participant_);
    auto& known = topics_[name];
    if (!known) known = participant_->create_topic(name, type, TOPIC_QOS_DEFAULT);
    return known;
  }

  DomainParticipant* participant_;
  std::map<std::string, Topic*> topics_;
  std::vector<std::pair<std::string, DataReader*>> readers_;
  mutable std::set<std::string> got_;
};

int main() {
  auto errors = std::make_unique<StdoutErrConsumer>();  // standard output is for answers
  errors->stderr_threshold(Log::Kind::Info);
  Log::ClearConsumers();
  Log::RegisterConsumer(std::move(errors));
  std::exit(serve<Secured>(stdout));
}
