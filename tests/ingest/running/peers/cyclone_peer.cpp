// Participants that are not ours (Cyclone DDS), each with the security plugins, of which the folder is the one argument;
// commands are those of secured_commands.hpp. A seat is not needed: Cyclone DDS takes the next one that is free.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <dds/dds.h>

#include "secured_commands.hpp"
#include "secured_text.h"

using Text = std_msgs_msg_dds__String_;

static std::string library(const std::string& plugins, const std::string& name, const std::string& what) {
  return "<Library path=\"" + plugins + "/libdds_security_" + name + ".so\" initFunction=\"init_" + what +
         "\" finalizeFunction=\"finalize_" + what + "\"/>";
}

static std::string file(const std::string& tag, const std::string& name) {
  return "<" + tag + ">file:" + name + "</" + tag + ">";
}

static std::string configured(const std::string& plugins, const std::string& folder) {
  std::string security;
  if (!folder.empty())
    security = "<Security><Authentication>" + library(plugins, "auth", "authentication") +
               file("IdentityCA", folder + "/identity_ca.cert.pem") + file("IdentityCertificate", folder + "/cert.pem") +
               file("PrivateKey", folder + "/key.pem") + "</Authentication><Cryptographic>" +
               library(plugins, "crypto", "crypto") + "</Cryptographic><AccessControl>" +
               library(plugins, "ac", "access_control") + file("Governance", folder + "/governance.p7s") +
               file("PermissionsCA", folder + "/permissions_ca.cert.pem") +
               file("Permissions", folder + "/permissions.p7s") + "</AccessControl></Security>";
  return "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>"
         "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<MaxAutoParticipantIndex>3</MaxAutoParticipantIndex><SPDPInterval>200ms</SPDPInterval>"
         "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>" + security;
}

class Secured {
 public:
  Secured(int domain, int, const std::string& folder, const std::string& plugins) {
    if (dds_create_domain(domain, configured(plugins, folder).c_str()) > 0)
      participant_ = dds_create_participant(domain, nullptr, nullptr);
  }

  bool there() const { return participant_ > 0; }

  bool writer(const std::string& name, const std::string& partition) {
    const auto qos = lasting(partition);
    const dds_entity_t where = dds_create_publisher(participant_, qos, nullptr);
    const dds_entity_t writer = dds_create_writer(where, topic(name), qos, nullptr);
    dds_delete_qos(qos);
    char data[] = "one";
    Text sample{data};
    return writer > 0 && dds_write(writer, &sample) == DDS_RETCODE_OK;
  }

  bool reader(const std::string& name, const std::string& partition) {
    const auto qos = lasting(partition);
    const dds_entity_t where = dds_create_subscriber(participant_, qos, nullptr);
    const dds_entity_t reader = dds_create_reader(where, topic(name), qos, nullptr);
    dds_delete_qos(qos);
    if (reader > 0) readers_.emplace_back(name, reader);
    return reader > 0;
  }

  std::string received() {
    for (const auto& [name, reader] : readers_) {
      void* samples[1] = {nullptr};
      dds_sample_info_t info[1];
      const int count = dds_read(reader, samples, info, 1, 1);
      if (count > 0 && info[0].valid_data) got_.insert(name);
      if (count > 0) dds_return_loan(reader, samples, count);
    }
    std::string names;
    for (const auto& name : got_) names += " " + name;
    return names;
  }

 private:
  static dds_qos_t* lasting(const std::string& partition) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    if (!partition.empty()) dds_qset_partition1(qos, partition.c_str());
    return qos;
  }

  dds_entity_t topic(const std::string& name) {
    auto& known = topics_[name];
    if (!known) known = dds_create_topic(participant_, &std_msgs_msg_dds__String__desc, name.c_str(), nullptr, nullptr);
    return known;
  }

  dds_entity_t participant_ = 0;
  std::map<std::string, dds_entity_t> topics_;
  std::vector<std::pair<std::string, dds_entity_t>> readers_;
  std::set<std::string> got_;
};

int main(int count, char** arguments) {
  FILE* answers = fdopen(dup(STDOUT_FILENO), "w");  // what Cyclone DDS prints itself goes to standard error
  dup2(STDERR_FILENO, STDOUT_FILENO);
  std::_Exit(serve<Secured>(answers, std::string(count > 1 ? arguments[1] : "")));
}
