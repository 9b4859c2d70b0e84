classdef sinew < handle
  % A continuum robot that answers questions.
  %
  %   r = sinew ("3pfs-g2")               a robot that comes with sinew, or a robot file
  %   a = r.forward ([0.44 0.42 0.41])    its pose from its inputs
  %   a.ok, a.status, a.message           whether that was solved, and why not
  %   a.pose.position, a.pose.quaternion
  %
  % Fields of a question follow as names and values:
  %
  %   a = r.forward ([0.44 0.42 0.41], "wrench", [0 0 -5 0 0 0], "want", {"stiffness"})
  %   b = r.inverse (a.pose), r.velocity, r.statics, r.track, r.diagram, r.shape,
  %                                       r.identify, r.describe
  %
  % A matrix with a row a configuration is answered by columns:
  %
  %   c = r.forward ([0.44 0.42 0.41; 0.43 0.42 0.41])
  %   c.position                          2 x 3, c.status and c.ok 2 x 1
  %
  % r.set (...) is the robot with other values, r.prepare (...) a question for many rows.
  % Everything is in SI units and radians. The manual is docs/octave.md; the fields of
  % questions and answers are in docs/protocol.md.

  properties (SetAccess = private)
    name = '';      % of the robot
    settings = {};  % what r.set changed: paths and values in turn
  end
  properties (Access = private)
    number = [];    % of the robot in sinew_mex
    kind = '';      % parallel, serial, arm or arm_legs
  end

  methods
    function r = sinew (source)
      % A robot of a name, a file, a text (one with a line break, or that begins with {) or a struct.
      if nargin ~= 1
        error ('sinew:bad_input', 'give a robot: sinew ("3pfs-g2"), a file, its text, or a struct.');
      end
      if isa (source, 'sinew')  % a session of its own
        r.number = sinew.checked ('share', source.number);
        r.settings = source.settings;
      elseif isstruct (source)
        r.number = sinew.checked ('open', source, 'struct');
      else
        source = sinew.plain (source);
        if ~ ischar (source)
          error ('sinew:bad_input', 'a robot is a name, a file, a text or a struct; found a %s.', class (source));
        end
        is_text = any (source == sprintf ('\n')) || (~ isempty (source) && source(1) == '{');
        kinds = {'file', 'text'};
        r.number = sinew.checked ('open', source, kinds{1 + is_text});
      end
      described = r.describe ();
      r.name = described.robot;
      r.kind = described.kind;
    end

    function a = forward (r, varargin)
      % Pose from inputs: r.forward (inputs, ...), of a serial robot r.forward (configuration, ...), of an arm
      % r.forward (tensions, ...)
      a = r.put ('forward', varargin);
    end

    function a = inverse (r, varargin)
      % Inputs from a pose: r.inverse (pose, ...), of a serial robot or an arm r.inverse (position, ...)
      a = r.put ('inverse', varargin);
    end

    function a = velocity (r, varargin)
      % Velocity equations and singularities: r.velocity (inputs or pose, ...)
      a = r.put ('velocity', varargin);
    end

    function a = statics (r, varargin)
      % Equilibrium of tendon-driven robots under load, forces sensed by rods: r.statics ("tensions", T, ...)
      a = r.put ('statics', varargin);
    end

    function a = track (r, varargin)
      % A path of poses, or a curve of equilibria: r.track ("from", pose, "to", pose, "samples", 20)
      a = r.put ('track', varargin);
    end

    function a = diagram (r, varargin)
      % What tendons leave a section of a serial robot free to do: r.diagram ("section", 0, "changes", [...])
      a = r.put ('diagram', varargin);
    end

    function a = shape (r, varargin)
      % Polylines for a picture: r.shape (inputs or pose, ...)
      a = r.put ('shape', varargin);
    end

    function a = identify (r, rows, varargin)
      % Parameters of an arm, fitted to measured rows: r.identify (rows, "fit", "bending,marker")
      %
      % rows is a struct of pulls (n x tendons) [m], markers (n x 3) [m] and, where known, time (n) [s] and
      % blocks (n); or a .csv file, or its text. The fitted arm is sinew (a.file).
      if nargin < 2
        error ('sinew:bad_input', 'identify: give the measured rows: r.identify (rows), a struct with pulls and markers, or a .csv file.');
      end
      rows = sinew.plain (rows);
      if ischar (rows) && ~ any (rows(:) == sprintf ('\n'))
        [file, why] = fopen (rows, 'r');
        if file < 0
          error ('sinew:bad_input', 'identify: the table %s cannot be read: %s', rows, why);
        end
        rows = fread (file, [1, Inf], '*char');
        fclose (file);
      end
      a = r.put ('identify', [{'rows', rows}, varargin]);
    end

    function a = describe (r, varargin)
      % What the robot has.
      a = r.put ('describe', varargin);
    end

    function a = ask (r, question)
      % Any question of docs/protocol.md, as a struct with the field query, or as JSON.
      question = sinew.plain (question);
      if isstruct (question) && isscalar (question) && isfield (question, 'query')
        fields = rmfield (question, 'query');
        a = r.put (question.query, reshape ([fieldnames(fields), struct2cell(fields)].', 1, []));
      elseif ischar (question) && isempty (r.settings)
        a = sinew.checked ('ask_text', r.number, question);
      else
        error ('sinew:bad_input', 'give a struct with the field query; of a robot without settings also JSON.');
      end
    end

    function changed = set (r, varargin)
      % The robot with other values: r.set ("legs[0].link.length", 0.21), or a struct of the file's form.
      changed = sinew (r);
      changed.settings = [r.settings, sinew.paths(sinew.plain (varargin))];
      changed.describe ();
    end

    function batch = prepare (r, query, varargin)
      % A question for many rows: b = r.prepare ("forward", "inputs", "$L"), then b.run (L).
      [fields, settings] = r.fields_of (query, sinew.plain (varargin));
      batch = sinew_batch (sinew.checked ('prepare', r.number, sinew.plain (query), fields, settings));
    end

    function disp (r)
      fprintf ('  sinew robot %s (%s)\n', r.name, r.kind);
    end

    function delete (r)
      if ~ isempty (r.number)
        sinew_mex ('close', r.number);
      end
    end
  end

  methods (Access = private)
    function a = put (r, query, fields)
      [fields, settings] = r.fields_of (query, sinew.plain (fields));
      [a, id, message] = sinew_mex ('ask', r.number, query, fields, settings);
      if ~ isempty (message)
        error (id, '%s', message);
      end
    end

    function [fields, settings] = fields_of (r, query, fields)
      % Names what comes first without a name, and takes out what is to be set.
      settings = r.settings;
      if mod (numel (fields), 2) == 1
        fields = [{r.subject(query, fields{1})}, fields];
      elseif ~ isempty (fields) && ~ ischar (fields{1})
        error ('sinew:bad_input', '%s: names and values come in turn after the first argument; the last name has no value.', query);
      end
      is_set = strcmp (fields(1:2:end), 'set');
      if any (is_set)
        k = 2 * find (is_set, 1);
        settings = [settings, sinew.paths(fields(k))];
        fields(k - 1 : k) = [];
      end
    end

    function name = subject (r, query, value)
      % What a question is mostly about.
      if isstruct (value)
        name = 'pose';
      elseif ischar (value)
        error ('sinew:bad_input', '%s: "%s" has no value; names and values come in turn.', query, value);
      elseif strcmp (r.kind, 'parallel')
        name = 'inputs';
      elseif strcmp (query, 'inverse')
        name = 'position';
      elseif strcmp (r.kind, 'serial')
        name = 'configuration';
      else
        name = 'tensions';
      end
    end
  end

  methods (Static)
    function names = status_names (codes)
      % Names of the statuses of rows, as a cell array.
      known = {'unreachable', 'left_domain', 'slack', 'singular', 'stalled', 'iteration_limit', ...
               'unstable', 'converged', 'stopped', 'bad_input', 'unsupported'};
      known(256) = {'failed'};
      names = reshape (known(double (codes) + 1), size (codes));
    end
  end

  methods (Static, Hidden)
    function value = checked (varargin)
      % What sinew_mex gives, or its error.
      [value, id, message] = sinew_mex (varargin{:});
      if ~ isempty (message)
        error (id, '%s', message);
      end
    end

    function pairs = paths (given)
      % Paths and values in turn, of such a list, a map or nested structs.
      if mod (numel (given), 2) == 0
        pairs = given(:).';
      elseif numel (given) == 1 && isstruct (given{1})
        pairs = sinew.leaves ('', given{1});
      elseif numel (given) == 1 && isa (given{1}, 'containers.Map')
        pairs = reshape ([given{1}.keys(); given{1}.values()], 1, []);
      else
        error ('sinew:bad_input', 'set: give paths and values in turn, a struct, or a containers.Map.');
      end
    end

    function value = plain (value)
      % Strings of MATLAB as characters; Octave has none.
      persistent has_strings
      if isempty (has_strings)
        has_strings = ~ exist ('OCTAVE_VERSION', 'builtin');
      end
      if has_strings
        value = convert_strings (value);
      end
    end
  end

  methods (Static, Access = private)
    function pairs = leaves (path, value)
      % [] is what a struct array has in elements that nobody set.
      pairs = {};
      if ~ isstruct (value)
        if ~ (isnumeric (value) && isempty (value))
          pairs = {path, value};
        end
        return
      end
      for k = 1:numel (value)
        place = path;
        if numel (value) > 1
          place = sprintf ('%s[%d]', path, k - 1);
        end
        for name = fieldnames (value).'
          dot = '.';
          if isempty (place)
            dot = '';
          end
          pairs = [pairs, sinew.leaves([place, dot, name{1}], value(k).(name{1}))]; %#ok<AGROW>
        end
      end
    end
  end
end

function value = convert_strings (value)
  if isa (value, 'string')
    value = convertStringsToChars (value);
  elseif iscell (value)
    value = cellfun (@convert_strings, value, 'UniformOutput', false);
  elseif isstruct (value)
    for k = 1:numel (value)
      for name = fieldnames (value).'
        value(k).(name{1}) = convert_strings (value(k).(name{1}));
      end
    end
  end
end
