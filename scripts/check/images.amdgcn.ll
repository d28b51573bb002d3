; Image reads for scripts/crosscompile, which libclc lacks: as AMD's own device library has them, the image being the
; address of its descriptor. Only for counting registers: nothing built with this is ever run.
target triple = "amdgcn--amdhsa"

declare <4 x float> @llvm.amdgcn.struct.buffer.load.format.v4f32(<4 x i32>, i32, i32, i32, i32)
declare <4 x float> @llvm.amdgcn.image.load.2d.v4f32.i32(i32, i32, i32, <8 x i32>, i32, i32)

define <4 x float> @_Z11read_imagef21ocl_image1d_buffer_roi(ptr addrspace(4) %image, i32 %x) alwaysinline {
  %descriptor = load <4 x i32>, ptr addrspace(4) %image, align 16
  %v = call <4 x float> @llvm.amdgcn.struct.buffer.load.format.v4f32(<4 x i32> %descriptor, i32 %x, i32 0, i32 0, i32 0)
  ret <4 x float> %v
}

define <4 x i32> @_Z12read_imageui21ocl_image1d_buffer_roi(ptr addrspace(4) %image, i32 %x) alwaysinline {
  %v = call <4 x float> @_Z11read_imagef21ocl_image1d_buffer_roi(ptr addrspace(4) %image, i32 %x)
  %u = bitcast <4 x float> %v to <4 x i32>
  ret <4 x i32> %u
}

define <4 x float> @_Z11read_imagef14ocl_image2d_ro11ocl_samplerDv2_i(ptr addrspace(4) %image, ptr addrspace(4) %s, <2 x i32> %at) alwaysinline {
  %descriptor = load <8 x i32>, ptr addrspace(4) %image, align 32
  %x = extractelement <2 x i32> %at, i32 0
  %y = extractelement <2 x i32> %at, i32 1
  %v = call <4 x float> @llvm.amdgcn.image.load.2d.v4f32.i32(i32 15, i32 %x, i32 %y, <8 x i32> %descriptor, i32 0, i32 0)
  ret <4 x float> %v
}

define <4 x i32> @_Z12read_imageui14ocl_image2d_ro11ocl_samplerDv2_i(ptr addrspace(4) %image, ptr addrspace(4) %s, <2 x i32> %at) alwaysinline {
  %v = call <4 x float> @_Z11read_imagef14ocl_image2d_ro11ocl_samplerDv2_i(ptr addrspace(4) %image, ptr addrspace(4) %s, <2 x i32> %at)
  %u = bitcast <4 x float> %v to <4 x i32>
  ret <4 x i32> %u
}

; A load takes no sampler.
define ptr addrspace(4) @__translate_sampler_initializer(i32 %flags) alwaysinline {
  ret ptr addrspace(4) null
}
