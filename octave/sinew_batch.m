classdef sinew_batch < handle
  % A question prepared for many rows by r.prepare.
  %
  %   b = r.prepare ("forward", "inputs", "$L", "outputs", {"pose.position"});
  %   a = b.run (L)                       L is n x 3; a.pose_position is n x 3
  %   b.inputs, b.outputs                 names, units and shapes of what goes in and comes out
  %   b.method                            how rows are computed

  properties (SetAccess = private)
    inputs
    outputs
    method
  end
  properties (Access = private)
    number = [];  % of the question in sinew_mex
  end

  methods
    function b = sinew_batch (number)
      % Called by r.prepare.
      b.number = number;
      fields = sinew.checked ('fields', number);
      b.inputs = fields.inputs;
      b.outputs = fields.outputs;
      b.method = fields.method;
    end

    function a = run (b, varargin)
      % One matrix for each of b.inputs, in their order, a row a configuration; then "threads", how many.
      threads = 0;
      if numel (varargin) >= 2 && strcmp (sinew.plain (varargin{end-1}), 'threads')
        threads = varargin{end};
        varargin(end-1:end) = [];
      end
      a = sinew.checked ('run', b.number, varargin, threads);
    end

    function disp (b)
      fprintf ('  sinew question for many rows (%s): %s -> %s\n', b.method, ...
               strjoin ({b.inputs.name}, ', '), strjoin ({b.outputs.name}, ', '));
    end

    function delete (b)
      if ~ isempty (b.number)
        sinew_mex ('close', b.number);
      end
    end
  end
end
