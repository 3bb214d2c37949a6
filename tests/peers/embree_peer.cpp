#include "tests/peers/embree_peer.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace limn::peers {

namespace {

struct ReleaseDevice {
  void operator()(RTCDevice device) const noexcept { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const noexcept { rtcReleaseScene(scene); }
};

}  // namespace

struct EmbreeMesh::Impl {
  std::unique_ptr<RTCDeviceTy, ReleaseDevice> device;
  std::unique_ptr<RTCSceneTy, ReleaseScene> scene;
};

EmbreeMesh::EmbreeMesh(const PeerMesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->device.reset(rtcNewDevice("threads=1"));
  if (impl_->device == nullptr) throw std::runtime_error("Embree makes no device");
  RTCDevice device = impl_->device.get();
  impl_->scene.reset(rtcNewScene(device));
  RTCScene scene = impl_->scene.get();
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), mesh.positions.size() / 3));
  auto* corners = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangle_count()));
  std::transform(mesh.positions.begin(), mesh.positions.end(), positions,
                 [](double x) { return static_cast<float>(x); });
  std::transform(mesh.triangles.begin(), mesh.triangles.end(), corners,
                 [](int i) { return static_cast<unsigned>(i); });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
    throw std::runtime_error("Embree refuses the mesh");
}

EmbreeMesh::EmbreeMesh(EmbreeMesh&&) noexcept = default;
EmbreeMesh& EmbreeMesh::operator=(EmbreeMesh&&) noexcept = default;
EmbreeMesh::~EmbreeMesh() = default;

std::optional<PeerMeshHit> EmbreeMesh::first_hit(const PeerRay& ray) const {
  RTCRayHit query;
  query.ray.org_x = static_cast<float>(ray.origin[0]);
  query.ray.org_y = static_cast<float>(ray.origin[1]);
  query.ray.org_z = static_cast<float>(ray.origin[2]);
  query.ray.dir_x = static_cast<float>(ray.direction[0]);
  query.ray.dir_y = static_cast<float>(ray.direction[1]);
  query.ray.dir_z = static_cast<float>(ray.direction[2]);
  query.ray.tnear = 0.0F;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.time = 0.0F;
  query.ray.mask = ~0U;
  query.ray.flags = 0;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene.get(), &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return PeerMeshHit{static_cast<double>(query.ray.tfar), static_cast<int>(query.hit.primID),
                     static_cast<double>(query.hit.u), static_cast<double>(query.hit.v)};
}

}  // namespace limn::peers
