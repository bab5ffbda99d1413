from .algorithms import Frame, Parameter, Sample, device_time, gathering, host_sync, pipeline
