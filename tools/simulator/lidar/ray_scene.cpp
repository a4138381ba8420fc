#include "tools/simulator/lidar/ray_scene.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace hairpin {
namespace {

constexpr size_t kPacket = 4;
constexpr const char* kDeviceConfig = "isa=sse4.2,threads=1,set_affinity=0";

}  // namespace

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayScene::RayScene() : embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice(kDeviceConfig);
  if (embree_->device == nullptr) throw std::runtime_error("Embree does not start");
  embree_->scene = rtcNewScene(embree_->device);
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

uint32_t RayScene::Add(const TriangleMesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const size_t vertex_bytes = 3 * sizeof(float);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           vertex_bytes, mesh.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(uint32_t), mesh.triangles.size());
  if (vertices == nullptr || triangles == nullptr)
    throw std::runtime_error("Embree takes no mesh of this size");
  auto* coordinates = static_cast<float*>(vertices);
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    coordinates = std::copy_n(vertex.data(), 3, coordinates);
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(embree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

void RayScene::Enable(uint32_t mesh, bool on) {
  const RTCGeometry geometry = rtcGetGeometry(embree_->scene, mesh);
  if (on) rtcEnableGeometry(geometry);
  if (!on) rtcDisableGeometry(geometry);
  rtcCommitGeometry(geometry);
}

void RayScene::Commit() { rtcCommitScene(embree_->scene); }

BeamHits RayScene::Cast(const Eigen::Vector3f& origin,
                        const std::array<Eigen::Vector3f, kRaysPerBeam>& directions,
                        float max_range) const {
  BeamHits hits;
  alignas(16) const int valid[kPacket] = {-1, -1, -1, -1};
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (size_t first = 0; first < kRaysPerBeam; first += kPacket) {
    RTCRayHit4 packet;
    for (size_t i = 0; i < kPacket; ++i) {
      const Eigen::Vector3f& direction = directions[first + i];
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = direction.x();
      packet.ray.dir_y[i] = direction.y();
      packet.ray.dir_z[i] = direction.z();
      packet.ray.tnear[i] = 0.0f;
      packet.ray.tfar[i] = max_range;
      packet.ray.time[i] = 0.0f;
      packet.ray.mask[i] = ~0u;
      packet.ray.id[i] = 0;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect4(valid, embree_->scene, &context, &packet);
    for (size_t i = 0; i < kPacket; ++i) {
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const Eigen::Vector3f normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
      RayHit& hit = hits[first + i];
      hit.range = packet.ray.tfar[i];
      hit.mesh = packet.hit.geomID[i];
      hit.cosine = std::abs(normal.dot(directions[first + i])) / normal.norm();
    }
  }
  return hits;
}

}  // namespace hairpin
