; Image reads for scripts/crosscompile, which libclc lacks: the texture instructions that NVIDIA's own compiler writes for
; them, with the image as a bindless handle. Only for counting registers: nothing built with this is ever run.
target triple = "nvptx64--nvidiacl"

declare { i32, i32, i32, i32 } @llvm.nvvm.tex.unified.1d.v4u32.s32(i64, i32)
declare { i32, i32, i32, i32 } @llvm.nvvm.tex.unified.2d.v4u32.s32(i64, i32, i32)

define <4 x i32> @_Z12read_imageui21ocl_image1d_buffer_roi(ptr addrspace(1) %image, i32 %x) alwaysinline {
  %handle = ptrtoint ptr addrspace(1) %image to i64
  %texel = call { i32, i32, i32, i32 } @llvm.nvvm.tex.unified.1d.v4u32.s32(i64 %handle, i32 %x)
  %v = call <4 x i32> @pack({ i32, i32, i32, i32 } %texel)
  ret <4 x i32> %v
}

define <4 x float> @_Z11read_imagef21ocl_image1d_buffer_roi(ptr addrspace(1) %image, i32 %x) alwaysinline {
  %v = call <4 x i32> @_Z12read_imageui21ocl_image1d_buffer_roi(ptr addrspace(1) %image, i32 %x)
  %f = bitcast <4 x i32> %v to <4 x float>
  ret <4 x float> %f
}

define <4 x i32> @_Z12read_imageui14ocl_image2d_ro11ocl_samplerDv2_i(ptr addrspace(1) %image, ptr addrspace(4) %s, <2 x i32> %at) alwaysinline {
  %handle = ptrtoint ptr addrspace(1) %image to i64
  %x = extractelement <2 x i32> %at, i32 0
  %y = extractelement <2 x i32> %at, i32 1
  %texel = call { i32, i32, i32, i32 } @llvm.nvvm.tex.unified.2d.v4u32.s32(i64 %handle, i32 %x, i32 %y)
  %v = call <4 x i32> @pack({ i32, i32, i32, i32 } %texel)
  ret <4 x i32> %v
}

define <4 x float> @_Z11read_imagef14ocl_image2d_ro11ocl_samplerDv2_i(ptr addrspace(1) %image, ptr addrspace(4) %s, <2 x i32> %at) alwaysinline {
  %v = call <4 x i32> @_Z12read_imageui14ocl_image2d_ro11ocl_samplerDv2_i(ptr addrspace(1) %image, ptr addrspace(4) %s, <2 x i32> %at)
  %f = bitcast <4 x i32> %v to <4 x float>
  ret <4 x float> %f
}

; The sampler is part of the texture's state.
define ptr addrspace(4) @__translate_sampler_initializer(i32 %flags) alwaysinline {
  ret ptr addrspace(4) null
}

define internal <4 x i32> @pack({ i32, i32, i32, i32 } %t) alwaysinline {
  %x = extractvalue { i32, i32, i32, i32 } %t, 0
  %y = extractvalue { i32, i32, i32, i32 } %t, 1
  %z = extractvalue { i32, i32, i32, i32 } %t, 2
  %w = extractvalue { i32, i32, i32, i32 } %t, 3
  %v0 = insertelement <4 x i32> undef, i32 %x, i32 0
  %v1 = insertelement <4 x i32> %v0, i32 %y, i32 1
  %v2 = insertelement <4 x i32> %v1, i32 %z, i32 2
  %v3 = insertelement <4 x i32> %v2, i32 %w, i32 3
  ret <4 x i32> %v3
}
