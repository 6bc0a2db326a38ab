/* Sizes and offsets that compiled pipelines, cffi and Embree rely on. Included by a C and a C++ file: both must agree. */
#include "oxrt/embree.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"

#ifdef __cplusplus
#define EXPECT(condition) static_assert(condition, #condition)
#define ALIGNMENT(type) alignof(type)
#else
#define EXPECT(condition) _Static_assert(condition, #condition)
#define ALIGNMENT(type) _Alignof(type)
#endif

/* Embree 4.4, one instance level, instance arrays. */
EXPECT(sizeof(struct RTCRay) == 48 && ALIGNMENT(struct RTCRay) == 16);
EXPECT(sizeof(struct RTCHit) == 48 && ALIGNMENT(struct RTCHit) == 16);
EXPECT(sizeof(struct RTCRayHit) == 96);
EXPECT(offsetof(struct RTCRay, tnear) == 12 && offsetof(struct RTCRay, tfar) == 32 && offsetof(struct RTCRay, mask) == 36);
EXPECT(offsetof(struct RTCHit, u) == 12 && offsetof(struct RTCHit, primID) == 20 && offsetof(struct RTCHit, geomID) == 24);
EXPECT(offsetof(struct RTCHit, instID) == 28 && offsetof(struct RTCHit, instPrimID) == 32);
EXPECT(sizeof(struct RTCRay8) == 12 * 32 && ALIGNMENT(struct RTCRay8) == 32);
EXPECT(sizeof(struct RTCRay16) == 12 * 64 && ALIGNMENT(struct RTCRay16) == 64);
EXPECT(sizeof(struct RTCRayHit8) == 21 * 32 && sizeof(struct RTCRayHit16) == 21 * 64);
EXPECT(offsetof(struct RTCRayHit16, hit) == 12 * 64 && offsetof(struct RTCHit16, instPrimID) == 8 * 64);
EXPECT(sizeof(struct RTCBounds) == 32 && sizeof(struct RTCLinearBounds) == 64 && sizeof(struct RTCQuaternionDecomposition) == 64);
EXPECT(sizeof(struct RTCRayQueryContext) == 8);
EXPECT(sizeof(struct RTCFilterFunctionNArguments) == 48 && offsetof(struct RTCFilterFunctionNArguments, N) == 40);
EXPECT(sizeof(struct RTCIntersectFunctionNArguments) == 48 && offsetof(struct RTCIntersectFunctionNArguments, rayhit) == 32);
EXPECT(offsetof(struct RTCIntersectFunctionNArguments, N) == 40 && offsetof(struct RTCIntersectFunctionNArguments, geomID) == 44);
EXPECT(sizeof(struct RTCIntersectArguments) == 40 && offsetof(struct RTCIntersectArguments, filter) == 16);
EXPECT(offsetof(struct RTCIntersectArguments, intersect) == 24 && offsetof(struct RTCOccludedArguments, occluded) == 24);
EXPECT(RTC_FORMAT_FLOAT3 == 0x9003 && RTC_FORMAT_UINT3 == 0x5003 && RTC_FORMAT_FLOAT3X4_ROW_MAJOR == 0x9134);

/* The host interface. */
EXPECT(sizeof(OxrtInstance) == 72 && offsetof(OxrtInstance, traversable) == 64);
EXPECT(sizeof(OxrtMotionOptions) == 12 && sizeof(OxrtAccelBuildOptions) == 16 && sizeof(OxrtTransformOptions) == 40);
EXPECT(sizeof(OxrtBuildInput) == 128 && offsetof(OxrtBuildInput, vertices) == 32 && offsetof(OxrtBuildInput, instances) == 80);
EXPECT(sizeof(OxrtContextOptions) == 40 && sizeof(OxrtAccelInfo) == 64 && sizeof(OxrtTextureOptions) == 40);
EXPECT(sizeof(OxrtProgramGroupDesc) == 72 && sizeof(OxrtShaderBindingTable) == 64 && offsetof(OxrtShaderBindingTable, missStride) == 24);

/* The interface of compiled pipelines. */
EXPECT(sizeof(OxrtRecordHeader) == OXRT_SBT_RECORD_HEADER_SIZE && offsetof(OxrtRecordHeader, pipelineUid) == 12);
EXPECT(sizeof(OxrtGeometry) == 120 && offsetof(OxrtGeometry, vertices) == 40 && offsetof(OxrtGeometry, opacityMicromaps) == 64);
EXPECT(sizeof(OxrtInstanceView) == 128 && offsetof(OxrtInstanceView, handle) == 112);
EXPECT(sizeof(OxrtTraversableView) == 112 && offsetof(OxrtTraversableView, handle) == 40);
EXPECT(sizeof(OxrtTraversableSlot) == 16 && sizeof(OxrtTextureSlot) == 16 && sizeof(OxrtTextureView) == 40);
EXPECT(sizeof(OxrtTile) == 24 && sizeof(OxrtProgram) == 24 && sizeof(OxrtPipelineVariant) == 24 && sizeof(OxrtPipelineBinary) == 32);
EXPECT(offsetof(OxrtThread, params) == 8 && offsetof(OxrtThread, index) == 16 && offsetof(OxrtThread, exceptionDetails) == 40);
EXPECT(offsetof(OxrtLaunch, traversables) == 88 && offsetof(OxrtLaunch, services) == 112 && offsetof(OxrtLaunch, cancel) == 120);
EXPECT(OXRT_PROGRAM_GROUP_KIND_HITGROUP == 0x2424 && sizeof(OxrtProgramGroupKind) == 4 && sizeof(OxrtResult) == 4);
