// SPDX-License-Identifier: MIT
#include "common/live/natnet/natnet_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/live/natnet/natnet_layout.h"
#include "common/live/wire/byte_writer.h"
#include "common/support/error.h"

namespace mmm_converter {
namespace {

constexpr std::int32_t kAssetId = 1;
constexpr std::uint64_t kTicksPerSecond = 10000000;
constexpr float kMarkerSize = 0.014F;          // [m]
constexpr std::int32_t kFirstCloudId = 50001;  // as Motive counts points without a label
constexpr std::chrono::seconds kForgetAfter{10};
constexpr const char* kAllMarkers = "all";

/// An asset with these markers: a trained marker set, or where there are none a skeleton whose
/// bones are not known, and the marker sets that go with it.
NatNetModel MakeModel(const std::string& asset, const std::vector<std::string>& labels) {
  NatNetModel model;
  std::vector<std::string> all;
  all.reserve(labels.size());
  for (const std::string& label : labels) all.push_back(fmt::format("{}_{}", asset, label));
  model.marker_sets = {{asset, labels}, {kAllMarkers, std::move(all)}};
  return model;
}

void AddAsset(const NatNetVersion& version, NatNetModel* model) {
  const NatNetMarkerSet& set = model->marker_sets.front();
  if (version < kNatNetWithSizes) {
    model->skeletons = {{set.name, kAssetId, {}}};
    return;
  }
  NatNetAsset asset;
  asset.name = set.name;
  asset.type = 1;
  asset.id = kAssetId;
  for (const std::string& name : set.markers) {
    const auto member = static_cast<std::int32_t>(asset.markers.size() + 1);
    asset.markers.push_back({name, kAssetId << 16 | member, {}, kMarkerSize, 0});
  }
  model->assets = {std::move(asset)};
}

std::array<float, 3> ToFloats(const Eigen::Vector3d& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

/// Points without a label stand among the labelled ones as well, where these tell what they are.
void AddOthers(const NatNetVersion& version, NatNetFrame* frame) {
  if (version < kNatNetWithMemberIds) return;
  std::int32_t id = kFirstCloudId;
  for (const auto& position : frame->other_markers) {
    const bool can_be_told = version >= kNatNet3;
    frame->markers.push_back(
        {id++, position, kMarkerSize,
         static_cast<std::int16_t>(kNatNetSolved | (can_be_told ? kNatNetUnlabelled : 0)), 0});
  }
}

}  // namespace

NatNetServer::NatNetServer(MarkerSequence recording, NatNetServerOptions options)
    : options_(std::move(options)),
      recording_(std::move(recording)),
      columns_(recording_.labels()),
      model_(MakeModel(options_.asset, columns_.labels)),
      rotation_(RotationToZUp(options_.up_axis).transpose()),
      playback_(recording_.num_frames(), recording_.rate(), options_.playback),
      command_(options_.address, options_.command_port) {
  CheckSize();
  if (!is_multicast()) return;
  group_ = FindUdpAddress(options_.group, options_.data_port);
  if ((group_.ip >> 28) != 0xE) {
    throw Error(fmt::format("{} is no multicast group; groups are 224.0.0.0 to 239.255.255.255",
                            options_.group));
  }
  command_.SendThrough(options_.address);
  playback_.Start();
}

NatNetServer::~NatNetServer() { Shutdown(); }

void NatNetServer::CheckSize() {
  Eigen::Index most_seen = -1;
  int fullest = 0;
  for (int k = 0; k < recording_.num_frames(); ++k) {
    const Eigen::Index seen = recording_.frame(k).row(0).array().isFinite().count();
    if (seen > most_seen) fullest = k;
    most_seen = std::max(most_seen, seen);
  }
  if (recording_.num_frames() > 0) MakeFrame(fullest);
  const std::string& bytes = FrameMessage(kNewestNatNet);
  NatNetModel model = model_;
  AddAsset(kNewestNatNet, &model);
  const std::size_t most =
      std::max(bytes.size(), FormatNatNetModel(model, kNewestNatNet).size()) + 64;
  if (most > kMostNatNetBytes) {
    throw Error(fmt::format(
        "{} markers have no room in a datagram of NatNet; serve fewer of them, or as QTM",
        recording_.num_labels()));
  }
}

void NatNetServer::Step(std::chrono::milliseconds wait) {
  const bool is_heard = is_multicast() || !clients_.empty();
  std::chrono::nanoseconds most = wait;
  if (playback_.is_running() && (is_heard || options_.playback.speed > 0)) {
    most = std::min(most, playback_.UntilNext());
  }
  const std::array sockets = {command_.Waiting()};
  WaitForSockets(sockets, most);
  UdpAddress sender;
  for (int i = 0; i < 256; ++i) {
    const auto datagram = command_.Receive(&sender);
    if (!datagram) break;
    try {
      Answer(ParseNatNetMessage(*datagram), sender);
    } catch (const Error&) {
      continue;  // no message that is known
    }
  }
  ForgetSilentClients();
  Play();
}

void NatNetServer::Play() {
  const bool is_fast = options_.playback.speed == 0;
  if (is_fast && clients_.empty() && !is_multicast()) return;
  while (const auto number = playback_.Take()) {
    MakeFrame(*number);
    SendFrame();
    if (is_fast) return;
  }
}

void NatNetServer::MakeFrame(std::int64_t number) {
  const auto points = recording_.frame(playback_.FrameOf(number));
  frame_.number = static_cast<std::int32_t>(number + 1);
  frame_.time = static_cast<double>(number) / recording_.rate();
  frame_.latency = static_cast<float>(frame_.time);
  frame_.marker_sets.resize(2);
  frame_.markers.clear();
  NatNetFrameMarkerSet& set = frame_.marker_sets[0];
  set.name = options_.asset;
  set.positions.assign(columns_.labelled.size(), {});
  for (std::size_t i = 0; i < columns_.labelled.size(); ++i) {
    const Eigen::Vector3d p = rotation_ * points.col(columns_.labelled[i]);
    if (!IsSeen(p)) continue;
    set.positions[i] = ToFloats(p);
    frame_.markers.push_back({kAssetId << 16 | static_cast<std::int32_t>(i + 1), set.positions[i],
                              kMarkerSize, kNatNetSolved | kNatNetHasModel, 0});
  }
  frame_.other_markers.clear();
  for (const Eigen::Index column : columns_.unlabelled) {
    const Eigen::Vector3d p = rotation_ * points.col(column);
    if (IsSeen(p)) frame_.other_markers.push_back(ToFloats(p));
  }
  frame_.marker_sets[1] = {kAllMarkers, set.positions};
  frame_.exposed = frame_.received = frame_.sent = Ticks();
  frame_.precise_seconds = static_cast<std::uint32_t>(frame_.sent / kTicksPerSecond);
  frame_.parameters = 0;
  messages_.clear();
  if (std::exchange(model_is_new_, false)) frame_.parameters |= kNatNetModelChanged;
}

const std::string& NatNetServer::FrameMessage(const NatNetVersion& version) {
  std::string& text = messages_[version];
  if (!text.empty()) return text;
  NatNetFrame frame = frame_;
  if (version < kNatNetWithSizes) {
    frame.skeletons = {{kAssetId, {}}};
  } else {
    frame.assets = {{kAssetId, {}, frame.markers}};
  }
  if (version < kNatNetWithMemberIds) {
    for (NatNetMarker& marker : frame.markers) marker.id &= 0xFFFF;
  }
  AddOthers(version, &frame);
  std::string payload;
  AppendNatNetFrame(frame, version, &payload);
  return text = FormatNatNetMessage(NatNetId::kFrame, payload);
}

void NatNetServer::SendFrame() {
  if (is_multicast()) command_.Send(FrameMessage(options_.version), group_);
  for (const Client& client : clients_) {
    command_.Send(FrameMessage(client.version), client.address);
  }
}

std::uint64_t NatNetServer::Ticks() const {
  using TickDuration = std::chrono::duration<std::int64_t, std::ratio<1, kTicksPerSecond>>;
  const auto since = options_.playback.now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<TickDuration>(since).count());
}

NatNetServer::Client* NatNetServer::FindClient(const UdpAddress& address) {
  const auto client = std::find_if(clients_.begin(), clients_.end(),
                                   [&](const Client& c) { return c.address == address; });
  return client == clients_.end() ? nullptr : &*client;
}

NatNetVersion NatNetServer::VersionOf(const UdpAddress& address) {
  const Client* client = FindClient(address);
  return client == nullptr ? options_.version : client->version;
}

void NatNetServer::TakeClient(const UdpAddress& address) {
  if (is_multicast()) return;
  if (Client* client = FindClient(address)) {
    client->heard_of = options_.playback.now();
    return;
  }
  if (clients_.size() >= options_.most_clients) return;
  clients_.push_back({address, options_.version, options_.playback.now()});
  if (!playback_.is_running()) playback_.Start();
}

void NatNetServer::TakeWishedVersion(std::string_view payload, const UdpAddress& address) {
  constexpr std::size_t kAt = 265;  // of 4.x clients
  Client* client = FindClient(address);
  if (client == nullptr || payload.size() < kAt + 4) return;
  const NatNetVersion version{static_cast<std::uint8_t>(payload[kAt]),
                              static_cast<std::uint8_t>(payload[kAt + 1])};
  if (version >= kNatNet4 && version < options_.version) client->version = version;
}

void NatNetServer::ForgetSilentClients() {
  const SteadyTime now = options_.playback.now();
  std::erase_if(clients_, [&](const Client& client) {
    if (now < client.heard_of + kForgetAfter) return false;
    Send(NatNetId::kDisconnectByTimeout, "", client.address);
    return true;
  });
}

void NatNetServer::Send(NatNetId id, std::string_view payload, const UdpAddress& to) {
  command_.Send(FormatNatNetMessage(id, payload), to);
}

void NatNetServer::Answer(const NatNetMessage& message, const UdpAddress& sender) {
  if (Client* client = FindClient(sender)) client->heard_of = options_.playback.now();
  switch (message.id) {
    case NatNetId::kConnect:
      TakeClient(sender);
      TakeWishedVersion(message.payload, sender);
      return SendServerInfo(sender);
    case NatNetId::kDiscovery:
      return SendServerInfo(sender);
    case NatNetId::kRequestModel:
      return SendModel(sender);
    case NatNetId::kRequest:
      return AnswerRequest(message.payload.substr(0, message.payload.find('\0')), sender);
    case NatNetId::kRequestFrame:
      command_.Send(FrameMessage(VersionOf(sender)), sender);
      return;
    case NatNetId::kEchoRequest: {
      if (message.payload.size() < sizeof(std::uint64_t)) return;
      std::string payload(message.payload.substr(0, sizeof(std::uint64_t)));
      ByteWriter(&payload).Put(Ticks());
      return Send(NatNetId::kEchoResponse, payload, sender);
    }
    case NatNetId::kKeepAlive:
      return;
    case NatNetId::kDisconnect:
      std::erase_if(clients_, [&](const Client& client) { return client.address == sender; });
      return;
    default:
      return Send(NatNetId::kUnrecognized, "", sender);
  }
}

void NatNetServer::AnswerRequest(std::string_view text, const UdpAddress& sender) {
  constexpr std::string_view kBitstream = "Bitstream,";
  std::string payload;
  ByteWriter writer(&payload);
  if (text == "FrameRate") {
    writer.Put(static_cast<float>(recording_.rate()));
  } else if (text == "AnalogSamplesPerMocapFrame") {
    writer.Put(std::int32_t{0});
  } else if (text.starts_with(kBitstream) && options_.version >= kNatNet4 && !is_multicast()) {
    Client* client = FindClient(sender);
    const NatNetVersion version = ParseNatNetVersion(std::string(text.substr(kBitstream.size())));
    const bool is_possible = client != nullptr && version <= options_.version;
    if (is_possible) client->version = version;
    writer.Put(std::int32_t{is_possible ? 0 : 1});
  } else {
    return Send(NatNetId::kUnrecognized, "", sender);
  }
  Send(NatNetId::kResponse, payload, sender);
}

void NatNetServer::SendModel(const UdpAddress& to) {
  const NatNetVersion version = VersionOf(to);
  NatNetModel model = model_;
  AddAsset(version, &model);
  Send(NatNetId::kModel, FormatNatNetModel(model, version), to);
}

void NatNetServer::SendServerInfo(const UdpAddress& to) {
  NatNetServerInfo info;
  info.application = "MMMConverterS2KF";
  info.application_version = {1, 0, 0, 0};
  info.version = VersionOf(to);
  info.clock_rate = kTicksPerSecond;
  info.data_port = static_cast<std::uint16_t>(options_.data_port);
  info.is_multicast = is_multicast();
  if (is_multicast()) info.group = options_.group;
  Send(NatNetId::kServerInfo, FormatNatNetServerInfo(info), to);
}

void NatNetServer::Replace(MarkerSequence recording) {
  const bool was_running = playback_.is_running();
  recording_ = std::move(recording);
  columns_ = PlayedColumns(recording_.labels());
  model_ = MakeModel(options_.asset, columns_.labels);
  playback_ = Playback(recording_.num_frames(), recording_.rate(), options_.playback);
  CheckSize();
  if (was_running) playback_.Start();
  model_is_new_ = true;
}

void NatNetServer::Shutdown() {
  for (const Client& client : clients_) Send(NatNetId::kDisconnect, "", client.address);
  clients_.clear();
}

}  // namespace mmm_converter
