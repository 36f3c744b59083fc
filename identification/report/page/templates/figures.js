/* Figures that one can zoom and read. Each svg tells in data-axes where its axes are:
   box [left, top, right, bottom] of the drawing, x and y [first, last, "linear" | "log" | "fixed"],
   the groups sx and sy that share them, and the ids and labels of its lines. */
(function () {
  "use strict";
  var NEAR = 30, DRAG = 6;  // of the drawing: how far a line may be read, how far a drag zooms

  document.querySelectorAll("svg[data-axes]").forEach(function (svg) {
    var every = JSON.parse(svg.getAttribute("data-axes"));
    var figure = svg.closest("figure"), tip = document.createElement("div");
    var reset = document.createElement("button"), begun = null;
    tip.className = "tip"; tip.hidden = true;
    reset.className = "reset"; reset.type = "button"; reset.textContent = "show all"; reset.hidden = true;
    figure.append(tip, reset);
    var mark = make("circle", {r: 3, class: "mark", visibility: "hidden"});
    var frame = make("rect", {class: "drag", visibility: "hidden"});

    every.forEach(function (ax) {
      ax.group = document.getElementById(ax.id);
      ax.view = {x: [ax.box[0], ax.box[2]], y: [ax.box[1], ax.box[3]]};
      ax.moved = null;
      ax.hit = make("rect", {x: ax.box[0], y: ax.box[1], width: ax.box[2] - ax.box[0],
                             height: ax.box[3] - ax.box[1], class: "hit"});
      svg.append(ax.hit);
      ax.hit.addEventListener("pointerdown", function (e) {
        if (e.button === 0 && e.pointerType !== "touch") { begun = at(e); ax.hit.setPointerCapture(e.pointerId); }
      });
      ax.hit.addEventListener("pointermove", function (e) { begun ? drag(ax, at(e)) : read(ax, at(e), e); });
      ax.hit.addEventListener("pointerup", function (e) {
        if (begun) { select(ax, begun, at(e)); } else { read(ax, at(e), e); }
        begun = null; frame.setAttribute("visibility", "hidden");
      });
      ax.hit.addEventListener("pointerleave", hush);
      ax.hit.addEventListener("dblclick", all);
    });
    svg.append(frame, mark);
    reset.addEventListener("click", all);

    function make(name, attributes) {
      var element = document.createElementNS(svg.namespaceURI, name);
      Object.keys(attributes).forEach(function (key) { element.setAttribute(key, attributes[key]); });
      return element;
    }
    function at(e) {
      var p = new DOMPoint(e.clientX, e.clientY).matrixTransform(svg.getScreenCTM().inverse());
      return [p.x, p.y];
    }
    function hush() { tip.hidden = true; mark.setAttribute("visibility", "hidden"); }

    /* Places of the whole drawing and of the zoomed one, and values. */
    function ends(ax, k) { return k === "x" ? [ax.box[0], ax.box[2]] : [ax.box[1], ax.box[3]]; }
    function shown(ax, k, p) {
      var e = ends(ax, k), v = ax.view[k];
      return e[0] + (p - v[0]) / (v[1] - v[0]) * (e[1] - e[0]);
    }
    function whole(ax, k, p) {
      var e = ends(ax, k), v = ax.view[k];
      return v[0] + (p - e[0]) / (e[1] - e[0]) * (v[1] - v[0]);
    }
    function value(ax, k, p) {
      var e = ends(ax, k), a = ax[k], part = (p - e[0]) / (e[1] - e[0]);
      if (k === "y") { part = 1 - part; }
      return a[2] === "log" ? a[0] * Math.pow(a[1] / a[0], part) : a[0] + part * (a[1] - a[0]);
    }
    function place(ax, k, v) {
      var e = ends(ax, k), a = ax[k];
      var part = a[2] === "log" ? Math.log(v / a[0]) / Math.log(a[1] / a[0]) : (v - a[0]) / (a[1] - a[0]);
      return k === "y" ? e[1] - part * (e[1] - e[0]) : e[0] + part * (e[1] - e[0]);
    }
    function number(v) {
      if (v === 0 || Math.abs(v) >= 1e-3 && Math.abs(v) < 1e5) { return String(Number(v.toPrecision(4))); }
      return v.toExponential(2);
    }

    /* Reading: the nearest corner of a line, or else the place itself. */
    function corners(one) {
      if (!one.corners) {
        var path = document.getElementById(one.id), d = path ? (path.querySelector("path") || path).getAttribute("d") : "";
        var n = ((d || "").match(/-?\d+\.?\d*(?:e-?\d+)?/g) || []).map(Number);
        one.corners = n;
      }
      return one.corners;
    }
    function read(ax, p, e) {
      var best = NEAR, found = null;
      ax.series.forEach(function (one) {
        var c = corners(one);
        for (var i = 0; i + 1 < c.length; i += 2) {
          var x = shown(ax, "x", c[i]), y = shown(ax, "y", c[i + 1]);
          var far = Math.hypot(1.5 * (x - p[0]), y - p[1]);
          if (far < best) { best = far; found = [x, y, one.label]; }
        }
      });
      var q = found || [p[0], p[1], ""], lines = found && found[2] ? [found[2]] : [];
      ["x", "y"].forEach(function (k, i) {
        if (ax[k][2] !== "fixed") { lines.push((ax.names[i] || k) + ": " + number(value(ax, k, whole(ax, k, q[i])))); }
      });
      tip.textContent = lines.join("\n");
      tip.hidden = false;
      var box = figure.getBoundingClientRect(), left = e.clientX - box.left;
      tip.style.left = Math.max(0, left > box.width / 2 ? left - tip.offsetWidth - 14 : left + 14) + "px";
      tip.style.top = (e.clientY - box.top + 12) + "px";
      mark.setAttribute("visibility", found ? "visible" : "hidden");
      mark.setAttribute("cx", q[0]); mark.setAttribute("cy", q[1]);
    }

    /* Zooming: what is drawn moves, its strokes and markers keep their size, its ticks are drawn anew. */
    function drag(ax, p) {
      hush();
      var high = Math.abs(p[1] - begun[1]) > 3 * DRAG && ax.y[2] !== "fixed";
      frame.setAttribute("visibility", "visible");
      frame.setAttribute("x", Math.min(p[0], begun[0])); frame.setAttribute("width", Math.abs(p[0] - begun[0]));
      frame.setAttribute("y", high ? Math.min(p[1], begun[1]) : ax.box[1]);
      frame.setAttribute("height", high ? Math.abs(p[1] - begun[1]) : ax.box[3] - ax.box[1]);
    }
    function select(ax, a, b) {
      [["x", 0, DRAG], ["y", 1, 3 * DRAG]].forEach(function (way) {
        var k = way[0], i = way[1], e = ends(ax, k);
        if (Math.abs(b[i] - a[i]) <= way[2] || ax[k][2] === "fixed") { return; }
        var ps = [a[i], b[i]].map(function (p) { return whole(ax, k, Math.min(e[1], Math.max(e[0], p))); });
        ps.sort(function (s, t) { return s - t; });
        every.forEach(function (other) {
          if (other === ax || other["s" + k] === ax["s" + k]) {
            var own = ends(other, k);
            other.view[k] = ps.map(function (p) { return own[0] + (p - e[0]) / (e[1] - e[0]) * (own[1] - own[0]); });
          }
        });
        reset.hidden = false;
      });
      every.forEach(draw);
    }
    function all() {
      every.forEach(function (ax) { ax.view = {x: ends(ax, "x"), y: ends(ax, "y")}; draw(ax); });
      reset.hidden = true; hush();
    }
    function movable(ax) {
      return Array.from(ax.group.querySelectorAll("[clip-path]")).filter(function (element) {
        return !element.closest('[id*="tick_"]');
      }).map(function (element) {
        var box = make("g", {"clip-path": element.getAttribute("clip-path")});
        element.replaceWith(box); box.append(element); element.removeAttribute("clip-path");
        var marks = Array.from(element.querySelectorAll("use")).filter(function (use) {
          var drawn = document.getElementById((use.getAttribute("xlink:href") || use.getAttribute("href")).slice(1));
          return Math.max.apply(null, (drawn.getAttribute("d").match(/-?\d+\.?\d*/g) || [0]).map(Math.abs)) < 25;
        });
        return {element: element, marks: marks.map(function (use) { return [use, Number(use.getAttribute("x")), Number(use.getAttribute("y"))]; })};
      });
    }
    function draw(ax) {
      ax.moved = ax.moved || movable(ax);
      var v = ax.view, s = ["x", "y"].map(function (k) {
        return (ends(ax, k)[1] - ends(ax, k)[0]) / (v[k][1] - v[k][0]);
      });
      var t = [ax.box[0] - s[0] * v.x[0], ax.box[1] - s[1] * v.y[0]];
      ax.moved.forEach(function (one) {
        if (!one.marks.length) { one.element.setAttribute("transform", "matrix(" + [s[0], 0, 0, s[1], t[0], t[1]] + ")"); }
        one.marks.forEach(function (m) { m[0].setAttribute("x", s[0] * m[1] + t[0]); m[0].setAttribute("y", s[1] * m[2] + t[1]); });
      });
      if (ax.ticks) { ax.ticks.remove(); }
      ax.ticks = make("g", {class: "ticks"});
      ["x", "y"].forEach(function (k, i) { if (ax[k][2] !== "fixed") { ticks(ax, k, Math.abs(s[i] - 1) > 1e-9); } });
      ax.group.firstElementChild.after(ax.ticks);  // over the ground, under the lines
    }
    function ticks(ax, k, zoomed) {
      var own = Array.from(ax.group.querySelectorAll('[id*="' + k + 'tick_"]'));
      own.forEach(function (one) { one.style.display = zoomed ? "none" : ""; });
      if (!zoomed) { return; }
      var labelled = own.some(function (one) { return one.querySelector("text"); });
      var v = ax.view[k].map(function (p) { return value(ax, k, p); }).sort(function (a, b) { return a - b; });
      var rough = (v[1] - v[0]) / 4, power = Math.pow(10, Math.floor(Math.log10(rough)));
      var step = [1, 2, 5, 10].map(function (f) { return f * power; }).find(function (f) { return f >= rough * 0.999; });
      for (var n = Math.ceil(v[0] / step); n * step <= v[1]; n += 1) {
        var p = shown(ax, k, place(ax, k, n * step)), b = ax.box;
        ax.ticks.append(make("line", k === "x" ? {x1: p, x2: p, y1: b[1], y2: b[3]} : {x1: b[0], x2: b[2], y1: p, y2: p}));
        if (labelled) {
          var text = make("text", k === "x" ? {x: p, y: b[3] + 12, "text-anchor": "middle"} : {x: b[0] - 5, y: p + 3, "text-anchor": "end"});
          text.textContent = number(n * step);
          ax.ticks.append(text);
        }
      }
    }
  });

  /* What is wider than the screen fades on the side where there is more of it. */
  document.querySelectorAll(".sideways").forEach(function (box) {
    function look() {
      var most = box.scrollWidth - box.clientWidth;
      box.classList.toggle("from", box.scrollLeft > 1);
      box.classList.toggle("on", box.scrollLeft < most - 1);
    }
    box.addEventListener("scroll", look);
    new ResizeObserver(look).observe(box);  // a table that is unfolded, a screen that is turned
    look();
  });
  document.documentElement.classList.add("scripted");
})();
